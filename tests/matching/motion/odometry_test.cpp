#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "voxlist/matching/motion/match_scatter.h"
#include "voxlist/matching/motion/pose_fusion.h"
#include "voxlist/matching/motion/tracked_pose.h"

namespace voxlist::matching {
namespace {

// Steps of half a metre on a wide arc.
const Pose2 kStep{0.5, 0.0, 0.02};

UncertainPose known(const Pose2& pose, double sigma_m, double sigma_rad = 0.001) {
  return {
      pose,
      Eigen::Vector3d(sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad).asDiagonal()};
}

// What wheels tell of a way that are two per cent too large, the laser being mounted a degree to
// the left.
constexpr double kTooLong = 1.02, kMount_rad = 0.0175;

Pose2 told(const Pose2& way) {
  const Eigen::Vector3d turned =
      Pose2{0.0, 0.0, -kMount_rad} * Eigen::Vector3d(way.x_m, way.y_m, 0);
  return {kTooLong * turned.x(), kTooLong * turned.y(), way.yaw_rad};
}

// A scan's match without an error beside those that are claimed.
UncertainPose match(const UncertainPose& expected, const UncertainPose& scan) {
  return fused(expected, {expected.pose, 1e6 * expected.covariance}, scan, Eigen::Matrix3d::Zero());
}

TEST(PoseFusion, GivesTheMatchBackWhereNothingIsDoubted) {
  const UncertainPose prior = known({1.0, 2.0, 0.3}, 0.1, 0.02),
                      matched = known({1.05, 2.0, 0.31}, 0.01);
  const UncertainPose pose = fused(prior, prior, matched, Eigen::Matrix3d::Zero());
  EXPECT_LT(distance_m(pose.pose, matched.pose), 1e-9);
  EXPECT_LT((pose.covariance - matched.covariance).norm(), 1e-9);
}

TEST(PoseFusion, LeavesThePredictionWhereTheScanToldNothing) {
  const UncertainPose predicted = known({1.0, 2.0, 0.3}, 0.1), prior = known(predicted.pose, 0.2);
  const UncertainPose pose = fused(predicted, prior, prior, 0.01 * Eigen::Matrix3d::Identity());
  EXPECT_LT(distance_m(pose.pose, predicted.pose), 1e-9);
  EXPECT_LT((pose.covariance - predicted.covariance).norm(), 1e-9);
}

TEST(PoseFusion, MeetsHalfWayWhereBothAreAsSure) {
  const UncertainPose predicted = known({}, 0.1), scan = known({0.2, 0.0, 0.0}, 0.06);
  const double scatter = 0.1 * 0.1 - 0.06 * 0.06;
  const UncertainPose pose = fused(predicted, predicted, match(predicted, scan),
                                   Eigen::Vector3d(scatter, scatter, 0.0).asDiagonal());
  EXPECT_NEAR(pose.pose.x_m, 0.1, 1e-6);
  EXPECT_NEAR(pose.covariance(0, 0), 0.005, 1e-6);
}

TEST(TrackedPose, LearnsWhatOdometryIsOffBy) {
  TrackedPose track(known({}, 0.001));
  Pose2 truth;
  for (int i = 0; i < 40; ++i) {
    truth = truth * kStep;
    track.follow_odometry(told(kStep), 1.0);
    track.learn(match(track.pose(), known(truth, 0.003)));
  }
  const OdometryBias bias = track.odometry();
  EXPECT_NEAR(bias.scale, 1.0 / kTooLong - 1.0, 0.004);
  EXPECT_NEAR(bias.heading_rad, kMount_rad, 0.004);
  EXPECT_LT(bias.scale_sigma, 0.01);
  // A way that no scan tells of is the better known for it.
  track.follow_odometry(told({10.0, 0.0, 0.0}), 20.0);
  const Pose2 there = truth * Pose2{10.0, 0.0, 0.0};
  EXPECT_LT(distance_m(track.pose().pose, there), 0.1);
  EXPECT_LT(mahalanobis2(there, track.pose()), 9.0);
}

TEST(TrackedPose, IsAsUnsureOfALongWayAsItsOdometry) {
  TrackedPose track(known({}, 0.001));
  track.follow_odometry({10.0, 0.0, 0.0}, 20.0);
  EXPECT_NEAR(std::sqrt(track.pose().covariance(0, 0)), 0.2, 0.05);
  EXPECT_NEAR(std::sqrt(track.pose().covariance(1, 1)), 0.3, 0.05);
}

// A drive on the arc, by odometry and matches.
struct Drive {
  TrackedPose track{known({}, 0.001)};
  MatchScatter scatter;
  Pose2 truth;

  void step(const Pose2& way, const Pose2& off) {
    truth = truth * kStep;
    track.follow_odometry(way, 1.0);
    const Pose2 seen{truth.x_m + off.x_m, truth.y_m + off.y_m, truth.yaw_rad};
    scatter.correct(track, match(scatter.expected(track.pose()), known(seen, 0.003)));
  }
  double error_m() const { return distance_m(track.pose().pose, truth); }
};

TEST(MatchScatter, IsFoundByOdometry) {
  std::mt19937 random(7);
  std::normal_distribution<double> off_m(0.0, 0.04);
  Drive drive;
  double squares = 0.0;
  for (int i = 0; i < 200; ++i) {
    drive.step(kStep, {off_m(random), off_m(random), 0.0});
    if (i >= 100) squares += drive.error_m() * drive.error_m();
  }
  EXPECT_NEAR(std::sqrt(drive.scatter.variances().x()), 0.04, 0.015);
  EXPECT_LT(std::sqrt(squares / 100), 0.7 * 0.04 * std::sqrt(2.0));
}

TEST(MatchScatter, IsNoneWhereOdometryErrsInstead) {
  std::mt19937 random(7);
  std::normal_distribution<double> off_m(0.0, 0.02);
  Drive drive;
  for (int i = 0; i < 100; ++i)
    drive.step({kStep.x_m + off_m(random), off_m(random), kStep.yaw_rad}, {});
  EXPECT_LT(std::sqrt(drive.scatter.variances().x()), 0.012);
  EXPECT_LT(drive.error_m(), 0.005);
}

TEST(MatchScatter, LetsWallsWinWhereWheelsSlip) {
  Drive drive;
  for (int i = 0; i < 20; ++i) drive.step(kStep, {});
  const OdometryBias before = drive.track.odometry();
  drive.step({0.1, 0.0, kStep.yaw_rad}, {});
  EXPECT_LT(drive.error_m(), 0.01);
  EXPECT_NEAR(drive.track.odometry().scale, before.scale, 0.002);
}

}  // namespace
}  // namespace voxlist::matching
