#include "voxlist/evaluation/evaluation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "voxlist/system/check.h"

namespace voxlist::evaluation {
namespace {

constexpr std::int64_t kSecond = 1'000'000;
constexpr std::int64_t kEpoch = 1'700'000'000 * kSecond;

/// Poses once a second from a start time.
io::PoseTable truth_of(const std::vector<Pose2>& poses, std::int64_t start_us = kEpoch) {
  io::PoseTable table;
  table.has_times = true;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto scan = static_cast<std::int64_t>(i);
    table.rows.push_back({scan, "", start_us + scan * kSecond, to_pose3(poses[i])});
  }
  return table;
}

std::vector<StampedPose3> estimate_of(const std::vector<Pose2>& poses,
                                      std::int64_t start_us = kEpoch) {
  std::vector<StampedPose3> estimate;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    estimate.push_back({start_us + static_cast<std::int64_t>(i) * kSecond, to_pose3(poses[i])});
  }
  return estimate;
}

const std::vector<Pose2> kLine{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}};

TEST(Evaluation, StatisticsAreTheTextbooks) {
  const auto s = statistics({4.0, 0.0, 3.0, 1.0});
  EXPECT_EQ(s.count, 4U);
  EXPECT_DOUBLE_EQ(s.rmse, std::sqrt(26.0 / 4.0));
  EXPECT_DOUBLE_EQ(s.mean, 2.0);
  EXPECT_DOUBLE_EQ(s.median, 2.0);
  EXPECT_DOUBLE_EQ(s.max, 4.0);
  EXPECT_EQ(statistics({}).count, 0U);
}

TEST(Evaluation, AMovedCopyOfTheTruthHasNoError) {
  const Pose2 T_estimate_truth{5.0, -2.0, 1.2};
  const std::vector<Pose2> truth{{0, 0, 0}, {1, 0, 0.5}, {2, 1, 1.5}, {2, 3, 3.0}};
  std::vector<Pose2> moved;
  for (const Pose2& pose : truth) {
    moved.push_back(T_estimate_truth * pose);
  }
  const auto errors = evaluate(estimate_of(moved), truth_of(truth));
  ASSERT_TRUE(errors);
  EXPECT_EQ(errors->matched, 4U);
  for (const auto& statistic : {errors->anchored_m, errors->anchored_heading_rad, errors->aligned_m,
                                errors->aligned_heading_rad, errors->step_m, errors->per_metre_m}) {
    EXPECT_GT(statistic.count, 0U);
    EXPECT_LT(statistic.max, 1e-9);
  }
  const Pose2 closed = errors->T_truth_estimate * T_estimate_truth;
  EXPECT_NEAR(distance_m(closed, {}), 0.0, 1e-9);
  EXPECT_NEAR(closed.yaw_rad, 0.0, 1e-9);
}

TEST(Evaluation, AnchoredAndAlignedErrorsAreThoseWorkedOutByHand) {
  // One step 0.4 m too long: anchored 0, 0, 0.4, 0.4; aligned +-0.2 about the shifted mean.
  const auto errors =
      evaluate(estimate_of({{0, 0, 0}, {1, 0, 0}, {2.4, 0, 0}, {3.4, 0, 0}}), truth_of(kLine));
  ASSERT_TRUE(errors);
  EXPECT_NEAR(errors->anchored_m.rmse, 0.4 / std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(errors->anchored_m.mean, 0.2, 1e-12);
  EXPECT_NEAR(errors->aligned_m.rmse, 0.2, 1e-12);
  EXPECT_NEAR(errors->end_position_m, 0.4, 1e-12);
  EXPECT_EQ(errors->step_m.count, 3U);
  EXPECT_NEAR(errors->step_m.max, 0.4, 1e-12);
  EXPECT_NEAR(errors->step_m.median, 0.0, 1e-12);
  EXPECT_EQ(errors->per_metre_m.count, 3U);
  EXPECT_NEAR(errors->per_metre_m.mean, 0.4 / 3.0, 1e-12);
}

TEST(Evaluation, PerMetreDividesByTheTrueLength) {
  const auto errors =
      evaluate(estimate_of({{0, 0, 0}, {4, 0.4, 0.2}}), truth_of({{0, 0, 0}, {4, 0, 0}}));
  ASSERT_TRUE(errors);
  EXPECT_NEAR(errors->per_metre_m.max, 0.1, 1e-12);
  EXPECT_NEAR(errors->per_metre_rad.max, 0.05, 1e-12);
  EXPECT_NEAR(errors->step_rad.max, 0.2, 1e-12);
  EXPECT_NEAR(errors->anchored_heading_rad.max, 0.2, 1e-12);
}

TEST(Evaluation, MatchesByTimeWithinHalfAnInterval) {
  auto estimate = estimate_of(kLine);
  estimate[1].utime_us += 400'000;
  estimate[2].utime_us += 600'000;
  estimate.erase(estimate.begin() + 3);
  const auto errors = evaluate(estimate, truth_of(kLine));
  ASSERT_TRUE(errors);
  EXPECT_EQ(errors->association, Association::kByTime);
  EXPECT_EQ(errors->in_truth, 4U);
  // The estimate of 2.6 s is the true pose's of 3 s.
  ASSERT_EQ(errors->matched, 3U);
  EXPECT_EQ(errors->poses[2].utime_us, kEpoch + 3 * kSecond);
  // The step over the pose that was left out is no step.
  EXPECT_EQ(errors->step_m.count, 1U);
}

TEST(Evaluation, MatchesByScanNumberWhenTimesDoNotMeet) {
  auto estimate = estimate_of(kLine, 0);
  estimate.erase(estimate.begin() + 1);
  const auto errors = evaluate(estimate, truth_of(kLine));
  ASSERT_TRUE(errors);
  EXPECT_EQ(errors->association, Association::kByScanNumber);
  EXPECT_EQ(errors->matched, 3U);
  EXPECT_LT(errors->anchored_m.max, 1e-12);
}

TEST(Evaluation, HeightsCountOnlyWhereTheTruthHasThem) {
  auto truth = truth_of(kLine);
  EXPECT_FALSE(evaluate(estimate_of(kLine), truth)->anchored_3d_m);
  truth.has_heights = true;
  for (io::PoseRow& row : truth.rows) {
    row.pose.translation().z() = 10.0;
  }
  truth.rows[3].pose.translation().z() = 10.5;
  const auto errors = evaluate(estimate_of(kLine), truth);
  EXPECT_NEAR(errors->anchored_3d_m->max, 0.5, 1e-12);
  EXPECT_LT(errors->anchored_m.max, 1e-12);
}

TEST(Evaluation, HasNoAnswerWhereNothingMatches) {
  EXPECT_FALSE(evaluate({}, truth_of(kLine)));
  EXPECT_FALSE(evaluate(estimate_of(kLine), {}));
}

TEST(Evaluation, OnePoseIsEnoughForAnAnswer) {
  const auto errors = evaluate(estimate_of({{3, 4, 0.1}}), truth_of({{0, 0, 0}}));
  ASSERT_TRUE(errors);
  EXPECT_EQ(errors->anchored_m.count, 1U);
  EXPECT_EQ(errors->step_m.count, 0U);
  EXPECT_EQ(evaluation::draw_errors(*errors).width(), 1000);
}

#if VOXLIST_CHECKS
TEST(AlignDeathTest, TakesPairsOfPoints) {
  EXPECT_DEATH(align({{0.0, 0.0}}, {}), "pairs of points");
}
#endif

}  // namespace
}  // namespace voxlist::evaluation
