#include "voxlist/adapter/robot_motion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "voxlist/geometry/mount.h"

namespace voxlist::adapter {
namespace {

StampedPose3 pose(std::int64_t utime_us, const Eigen::Vector3d& position, double roll_deg,
                  double pitch_deg, double yaw_deg) {
  return {utime_us, mount_pose(position, roll_deg, pitch_deg, yaw_deg)};
}

TEST(RobotMotion, IsThePlanesWhereTheRobotIsLevel) {
  RobotMotion motion;
  OdometryBuffer plane;
  for (int i = 0; i <= 5; ++i) {
    const StampedPose2 at{i * 20'000, {0.02 * i, 0.001 * i * i, 0.03 * i}};
    motion.add({at.utime_us, to_pose3(at.pose)});
    plane.add({at.utime_us, to_pose2(to_pose3(at.pose))});
  }
  for (const std::int64_t utime_us : {0, 7'000, 55'555, 100'000, 120'000}) {
    const Pose3 expected = to_pose3(*plane.estimate(utime_us, 30'000));
    EXPECT_TRUE(motion.at(utime_us, 30'000)->isApprox(expected, 1e-14)) << utime_us;
  }
  EXPECT_FALSE(motion.at(-1, 30'000));
  EXPECT_FALSE(motion.at(130'001, 30'000));
  EXPECT_EQ(motion.newest_utime_us(), 100'000);
}

TEST(RobotMotion, TurnsEvenlyBetweenTwoTilts) {
  RobotMotion motion;
  motion.add(pose(0, {0, 0, 0.0}, 0.0, 4.0, 30.0));
  motion.add(pose(20'000, {0, 0, 0.1}, 0.0, 8.0, 30.0));
  const Pose3 half = *motion.at(10'000, 0);
  const Pose3 expected = mount_pose({0, 0, 0.05}, 0.0, 6.0, 30.0);
  EXPECT_LT((half.matrix() - expected.matrix()).norm(), 1e-12);
  EXPECT_LT((motion.at(20'000, 0)->matrix() - mount_pose({0, 0, 0.1}, 0, 8, 30).matrix()).norm(),
            1e-12);
}

TEST(RobotMotion, HoldsTheTiltAfterTheNewest) {
  RobotMotion motion;
  motion.add(pose(0, {0, 0, 0}, 0.0, 5.0, 0.0));
  motion.add(pose(20'000, {0.02, 0, 0}, 0.0, 5.0, 0.0));
  const Pose3 expected = mount_pose({0.03, 0, 0}, 0, 5, 0);
  EXPECT_LT((motion.at(30'000, 20'000)->matrix() - expected.matrix()).norm(), 1e-9);
}

TEST(RobotMotion, ForgetsWhatWasBeforeTimeStartedAnew) {
  RobotMotion motion;
  motion.add(pose(10'000'000, {9, 9, 9}, 0, 9, 0));
  motion.add(pose(0, {0, 0, 0}, 0, 0, 0));
  motion.add(pose(20'000, {0, 0, 0}, 0, 0, 0));
  EXPECT_LT((motion.at(10'000, 0)->matrix() - Eigen::Matrix4d::Identity()).norm(), 1e-12);
  EXPECT_FALSE(motion.at(10'000'000, 0));
}

TEST(Levelled, KeepsPlaceAndHeading) {
  const Pose3 level = levelled(mount_pose({1, 2, 3}, 7.0, -5.0, 40.0));
  EXPECT_LT((level.matrix() - mount_pose({1, 2, 3}, 0, 0, 40.0).matrix()).norm(), 1e-12);
}

}  // namespace
}  // namespace voxlist::adapter
