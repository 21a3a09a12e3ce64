#include "voxlist/matching/localisation/pose_track.h"

#include <gtest/gtest.h>

#include <cmath>

namespace voxlist::matching {
namespace {

constexpr MotionLimits kLimits{2.0, 2.0};

// A step of half a metre a second, after which the robot stands at 0.5 m.
constexpr std::int64_t kStep_us = 1'000'000;
const Pose2 kStep{0.5, 0.0, 0.1};

UncertainPose exactly(const Pose2& pose) {
  return {pose, Eigen::Vector3d(1e-6, 1e-6, 1e-8).asDiagonal()};
}

PoseTrack after_a_step(const std::optional<Pose2>& T_odom_base = std::nullopt) {
  const Pose2 begin = T_odom_base.value_or(Pose2{}) * kStep.inverse();
  PoseTrack track(0, begin, exactly({}), kLimits);
  track.advance(kStep_us, T_odom_base, exactly(kStep));
  return track;
}

double sigma_x_m(const UncertainPose& pose) { return std::sqrt(pose.covariance(0, 0)); }

void expect_at(const Pose2& pose, const Pose2& expected, double tolerance = 1e-9) {
  EXPECT_LT(distance_m(pose, expected), tolerance);
  EXPECT_LT(turn_rad(pose, expected), tolerance);
}

TEST(PoseTrack, ExpectsTheRobotWithinItsSpeedBeforeItHasTakenAStep) {
  const Pose2 pose{1.0, 2.0, 3.0};
  const UncertainPose predicted =
      PoseTrack(0, std::nullopt, exactly(pose), kLimits).predict(kStep_us, std::nullopt);
  expect_at(predicted.pose, pose);
  EXPECT_NEAR(3.0 * sigma_x_m(predicted), kLimits.speed_mps, 0.01);
}

TEST(PoseTrack, ExpectsAnotherStepLikeTheLast) {
  const UncertainPose predicted = after_a_step().predict(2 * kStep_us, std::nullopt);
  expect_at(predicted.pose, kStep * kStep);
  EXPECT_LT(3.0 * sigma_x_m(predicted), kLimits.speed_mps);
}

TEST(PoseTrack, ExpectsAsMuchOfAStepAsTheTimeAllows) {
  expect_at(after_a_step().predict(kStep_us + kStep_us / 2, std::nullopt).pose,
            kStep * part_of(kStep, 0.5), 1e-3);
}

TEST(PoseTrack, ExpectsNoStepAfterALongPause) {
  const UncertainPose predicted = after_a_step().predict(61 * kStep_us, std::nullopt);
  expect_at(predicted.pose, kStep);
  EXPECT_GT(sigma_x_m(predicted), 10.0);
}

TEST(PoseTrack, FollowsOdometryHoweverLongThePause) {
  const Pose2 before{7.0, 8.0, 1.0}, moved{3.0, -1.0, 0.5};
  const UncertainPose predicted = after_a_step(before).predict(600 * kStep_us, before * moved);
  expect_at(predicted.pose, kStep * moved);
  EXPECT_LT(sigma_x_m(predicted), 0.1 * distance_m({}, moved));
}

TEST(PoseTrack, ExpectsAStepWhereOdometryHasFailedSince) {
  expect_at(after_a_step(Pose2{7.0, 8.0, 1.0}).predict(2 * kStep_us, std::nullopt).pose,
            kStep * kStep);
}

// Along a corridor nothing tells how far the robot went: each step's doubt comes to the last one's.
TEST(PoseTrack, DoubtsMoreAndMoreWhereNothingTellsTheWay) {
  PoseTrack by_wheels(0, Pose2{}, exactly({}), kLimits), by_guess = by_wheels;
  double wheels_m = 0.0, guess_m = 0.0;
  for (int i = 1; i < 10; ++i) {
    const std::optional<Pose2> odometry = Pose2{0.5 * i, 0.0, 0.0};
    const UncertainPose a = by_wheels.predict(i * kStep_us, odometry),
                        b = by_guess.predict(i * kStep_us, std::nullopt);
    EXPECT_GT(sigma_x_m(a), wheels_m);
    EXPECT_GT(sigma_x_m(b), guess_m);
    wheels_m = sigma_x_m(a), guess_m = sigma_x_m(b);
    by_wheels.advance(i * kStep_us, odometry, a);
    by_guess.advance(i * kStep_us, std::nullopt, b);
  }
  EXPECT_LT(wheels_m, 0.3);
  EXPECT_GT(guess_m, 3.0);
}

TEST(PoseTrack, IsInDoubtAfterTwoBadScansAndForgetsThemAfterAGoodOne) {
  PoseTrack track = after_a_step();
  track.doubt(0.0);
  EXPECT_FALSE(track.doubtful());
  track.doubt(0.0);
  EXPECT_TRUE(track.doubtful());
  track.doubt(1.0);
  EXPECT_FALSE(track.doubtful());
}

}  // namespace
}  // namespace voxlist::matching
