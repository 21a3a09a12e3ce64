#include "voxlist/matching/localisation/odometry_check.h"

#include <gtest/gtest.h>

namespace voxlist::matching {
namespace {

constexpr std::int64_t kSecond_us = 1'000'000;

UncertainPose sure(const Pose2& pose, double along_m = 0.005) {
  return {pose, Eigen::Vector3d(along_m * along_m, 2.5e-5, 1e-6).asDiagonal()};
}

// The last error of a drive of that many steps a second apart: those of the robot, and what
// odometry makes of them.
OdometryError drive(int steps, const Pose2& step, const Pose2& by_odometry,
                    double along_m = 0.005) {
  OdometryCheck check;
  Pose2 pose, odometry{7.0, -3.0, 2.0};
  check.add(0, sure(pose, along_m), odometry);
  OdometryError last;
  for (int i = 1; i <= steps; ++i) {
    pose = pose * step;
    odometry = odometry * by_odometry;
    const auto error = check.add(i * kSecond_us, sure(pose, along_m), odometry);
    EXPECT_TRUE(error);
    if (error) last = *error;
  }
  return last;
}

TEST(OdometryCheck, TellsAWayOfWhichWheelsHaveSlipped) {
  const OdometryError error = drive(1, {0.2, 0.0, 0.0}, {0.6, 0.0, 0.05});
  EXPECT_TRUE(error.disagrees());
  EXPECT_NEAR(error.way_m, 0.6, 1e-9);
  EXPECT_NEAR(error.distance_m, 0.4, 1e-9);
  EXPECT_NEAR(error.turn_rad, 0.05, 1e-9);
  EXPECT_EQ(error.seconds, 1.0);
}

TEST(OdometryCheck, StandsWheelsThatAreAFewPerCentOff) {
  for (const int steps : {1, 3, 20}) {
    EXPECT_FALSE(drive(steps, {0.6, 0.0, 0.1}, {0.63, 0.0, 0.105}).disagrees()) << steps;
    EXPECT_FALSE(drive(steps, {0.0, 0.0, 0.0}, {0.001, 0.0, 0.0005}).disagrees()) << steps;
  }
}

TEST(OdometryCheck, SeesOverManyStepsWhatOneDoesNotShow) {
  const Pose2 step{0.3, 0.0, 0.0}, by_odometry{0.4, 0.0, 0.0};
  EXPECT_FALSE(drive(1, step, by_odometry).disagrees());
  const OdometryError error = drive(8, step, by_odometry);
  EXPECT_TRUE(error.disagrees());
  EXPECT_GT(error.seconds, 1.0);
}

TEST(OdometryCheck, DoesNotBlameOdometryAlongACorridor) {
  EXPECT_TRUE(drive(1, {0.1, 0.0, 0.0}, {0.6, 0.0, 0.0}).disagrees());
  EXPECT_FALSE(drive(1, {0.1, 0.0, 0.0}, {0.6, 0.0, 0.0}, 0.3).disagrees());
}

TEST(OdometryCheck, ForgetsASlipAfterTenSeconds) {
  OdometryCheck check;
  check.add(0, sure({}), Pose2{});
  for (int i = 1; i <= 12; ++i) {
    const auto error = check.add(i * kSecond_us, sure({}), Pose2{1.0, 0.0, 0.0});
    ASSERT_TRUE(error);
    EXPECT_EQ(error->disagrees(), i <= 10) << i;
  }
}

TEST(OdometryCheck, SaysNothingWithoutOdometryOrWhereTheRobotWasFoundAnew) {
  OdometryCheck check;
  EXPECT_FALSE(check.add(0, sure({}), Pose2{}));
  EXPECT_FALSE(check.add(kSecond_us, sure({}), std::nullopt));
  EXPECT_FALSE(check.add(2 * kSecond_us, sure({}), Pose2{5.0, 0.0, 0.0}));
  check.clear();
  EXPECT_FALSE(check.add(3 * kSecond_us, sure({}), Pose2{9.0, 0.0, 0.0}));
}

}  // namespace
}  // namespace voxlist::matching
