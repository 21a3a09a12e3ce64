#include "voxlist/matching/localisation/pose_track.h"

#include <gtest/gtest.h>

namespace voxlist::matching {
namespace {

constexpr Evidence kAgrees{.points = 100, .hits = 98, .misses = 2, .rays = 100};

Cloud cloud_at(std::int64_t utime_us) {
  Cloud cloud;
  cloud.utime_us = utime_us;
  return cloud;
}

MatchMode mode_at(const Pose2& pose) {
  MatchMode mode;
  mode.pose = pose;
  mode.overlap_ratio = mode.inlier_ratio = 0.9;
  return mode;
}

// How a pose is judged that agrees with the map but lies `off_m` from where the robot was, while
// odometry, if there is any, says that it stood.
PoseTrack::Verdict verdict(double off_m, bool with_odometry) {
  const auto odometry = with_odometry ? std::optional(Pose2{}) : std::nullopt;
  const PoseTrack track(cloud_at(0), odometry, {}, 0.98);
  return track.judge(cloud_at(1'000'000), odometry, mode_at({off_m, 0.0, 0.0}), kAgrees).verdict;
}

TEST(PoseTrack, DoubtsAMotionThatOdometryDenies) {
  EXPECT_EQ(verdict(0.02, true), PoseTrack::Verdict::kExplains);
  EXPECT_EQ(verdict(0.3, true), PoseTrack::Verdict::kDoubtful);
}

TEST(PoseTrack, BelievesAnyMotionThatNothingMeasured) {
  EXPECT_EQ(verdict(0.3, false), PoseTrack::Verdict::kExplains);
}

TEST(PoseTrack, ValuesADeniedMotionLess) {
  const PoseTrack track(cloud_at(0), Pose2{}, {}, 0.98);
  const auto worth = [&](double off_m) {
    return track.judge(cloud_at(1'000'000), Pose2{}, mode_at({off_m, 0.0, 0.0}), kAgrees).worth;
  };
  EXPECT_LT(worth(0.3), worth(0.02) - 0.05);
  EXPECT_EQ(worth(0.3), worth(3.0)) << "wheels slip: it never counts for more";
}

// A step of half a metre a second, after which the robot stands at 0.5 m.
constexpr std::int64_t kStep_us = 1'000'000;
const Pose2 kStep{0.5, 0.0, 0.1};

PoseTrack after_a_step(const std::optional<Pose2>& T_odom_base = std::nullopt) {
  PoseTrack track(cloud_at(0), Pose2{}, {}, 0.98);
  track.advance(cloud_at(kStep_us), T_odom_base, mode_at(kStep), kAgrees);
  return track;
}

TEST(PoseTrack, ExpectsTheRobotWhereItWasBeforeItHasTakenAStep) {
  const Pose2 pose{1.0, 2.0, 3.0};
  EXPECT_EQ(PoseTrack(cloud_at(0), std::nullopt, pose, 0.98).predict(kStep_us, std::nullopt), pose);
}

TEST(PoseTrack, ExpectsAnotherStepLikeTheLast) {
  EXPECT_EQ(after_a_step().predict(2 * kStep_us, std::nullopt), kStep * kStep);
}

TEST(PoseTrack, ExpectsNoStepAfterAPause) {
  for (const std::int64_t pause_us : {3 * kStep_us, 60 * kStep_us})
    EXPECT_EQ(after_a_step().predict(kStep_us + pause_us, std::nullopt), kStep) << pause_us;
}

// What it moved during the pause says nothing of the second after that.
TEST(PoseTrack, ExpectsNoStepAsLongAsThePauseBefore) {
  PoseTrack track = after_a_step();
  const Pose2 after_pause = kStep * Pose2{4.0, 0.0, 0.0};
  track.advance(cloud_at(11 * kStep_us), std::nullopt, mode_at(after_pause), kAgrees);
  EXPECT_EQ(track.predict(12 * kStep_us, std::nullopt), after_pause);
}

TEST(PoseTrack, ExpectsNoStepBackInTime) {
  EXPECT_EQ(after_a_step().predict(kStep_us, std::nullopt), kStep);
  EXPECT_EQ(after_a_step().predict(0, std::nullopt), kStep);
}

TEST(PoseTrack, FollowsOdometryHoweverLongThePause) {
  const Pose2 before{7.0, 8.0, 1.0}, moved{3.0, -1.0, 0.5};
  const Pose2 predicted = after_a_step(before).predict(600 * kStep_us, before * moved);
  EXPECT_LT(distance_m(predicted, kStep * moved), 1e-9);
  EXPECT_LT(turn_rad(predicted, kStep * moved), 1e-9);
}

TEST(PoseTrack, ExpectsAStepWhereOdometryHasFailedSince) {
  EXPECT_EQ(after_a_step(Pose2{7.0, 8.0, 1.0}).predict(2 * kStep_us, std::nullopt), kStep * kStep);
}

// Agrees less by more than it takes to doubt a pose that was sure.
constexpr Evidence kAgreesLess{.points = 100, .hits = 90, .misses = 10, .rays = 100};
constexpr Evidence kDisagrees{.points = 100, .hits = 50, .misses = 50, .rays = 100};
constexpr Evidence kUnknown{.points = 100, .hits = 5, .unknown = 95, .rays = 100};

PoseTrack::Verdict verdict(const PoseTrack& track, const Evidence& evidence) {
  return track.judge(cloud_at(100 * kStep_us), std::nullopt, mode_at({}), evidence).verdict;
}

TEST(PoseTrack, DoubtsAPoseThatTheMapSupportsLessThanThoseBefore) {
  const PoseTrack track = after_a_step();
  EXPECT_EQ(verdict(track, kAgrees), PoseTrack::Verdict::kExplains);
  EXPECT_EQ(verdict(track, kAgreesLess), PoseTrack::Verdict::kDoubtful);
  EXPECT_EQ(verdict(track, kDisagrees), PoseTrack::Verdict::kLost);
}

TEST(PoseTrack, GetsUsedToAPlaceThatTheMapSupportsLess) {
  PoseTrack track = after_a_step();
  for (int i = 2; i < 10; ++i)
    track.advance(cloud_at(i * kStep_us), std::nullopt, mode_at({}), kAgreesLess);
  EXPECT_EQ(verdict(track, kAgreesLess), PoseTrack::Verdict::kExplains);
}

TEST(PoseTrack, LearnsNothingWhereTheMapKnowsNothing) {
  PoseTrack track = after_a_step();
  for (int i = 2; i < 10; ++i)
    track.advance(cloud_at(i * kStep_us), std::nullopt, mode_at({}), kUnknown);
  EXPECT_EQ(verdict(track, kUnknown), PoseTrack::Verdict::kExplains);
  EXPECT_EQ(verdict(track, kAgreesLess), PoseTrack::Verdict::kDoubtful);
}

TEST(PoseTrack, TakesAsLostWhatFitsFarWorseThanTheScanBefore) {
  MatchMode worse = mode_at({});
  worse.inlier_ratio = 0.3;
  const auto judged = [&](const PoseTrack& track) {
    return track.judge(cloud_at(kStep_us), std::nullopt, worse, kAgrees).verdict;
  };
  EXPECT_EQ(judged(PoseTrack(cloud_at(0), std::nullopt, {}, 0.98)), PoseTrack::Verdict::kExplains);
  EXPECT_EQ(judged(after_a_step()), PoseTrack::Verdict::kLost);
}

}  // namespace
}  // namespace voxlist::matching
