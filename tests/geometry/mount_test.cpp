#include "voxlist/geometry/mount.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace voxlist {
namespace {

using Eigen::Vector3d;

void expect_near(const Vector3d& a, const Vector3d& b) {
  EXPECT_LT((a - b).norm(), 1e-12) << a.transpose() << " instead of " << b.transpose();
}

TEST(MountPose, MovesAPointOfALevelSensor) {
  expect_near(mount_pose({0.5, -0.2, 0.8}, 0, 0, 0) * Vector3d(1, 2, 3), {1.5, 1.8, 3.8});
}

TEST(MountPose, PitchedDownLooksAtTheFloor) {
  const Vector3d ahead = mount_pose({0, 0, 1}, 0, 30, 0) * Vector3d(2, 0, 0);
  expect_near(ahead, {std::sqrt(3.0), 0, 0});
}

TEST(MountPose, TurnsAboutXThenYThenZ) {
  // y goes to z by the roll, to x by the pitch, to y by the yaw.
  expect_near(mount_pose({0, 0, 0}, 90, 90, 90) * Vector3d(0, 1, 0), {0, 1, 0});
  // x stays by the roll, goes to -z by the pitch, and stays there.
  expect_near(mount_pose({0, 0, 0}, 90, 90, 90) * Vector3d(1, 0, 0), {0, 0, -1});
}

TEST(MountPose, UpsideDownSwapsLeftAndRight) {
  expect_near(mount_pose({0, 0, 2}, 180, 0, 0) * Vector3d(3, 1, 0.5), {3, -1, 1.5});
}

TEST(BodyBoxes, HoldWhatIsInOneOfThem) {
  const BodyBoxes boxes({-1, 1, -0.5, 0.5, 0, 0.3, 2, 3, 2, 3, 2, 3}, "boxes");
  EXPECT_TRUE(boxes.hold({0, 0, 0.1}));
  EXPECT_TRUE(boxes.hold({1, 0.5, 0.3})) << "a corner";
  EXPECT_TRUE(boxes.hold({2.5, 2.5, 2.5}));
  EXPECT_FALSE(boxes.hold({0, 0, 0.31}));
  EXPECT_FALSE(boxes.hold({2.5, 2.5, 0.1}));
  EXPECT_FALSE(BodyBoxes({}, "boxes").hold({0, 0, 0}));
}

TEST(BodyBoxes, RefuseNumbersThatAreNoBoxes) {
  EXPECT_THROW(BodyBoxes({1, 2, 3}, "boxes"), std::invalid_argument);
  EXPECT_THROW(BodyBoxes({0, 1, 0, 1, 1, 1}, "boxes"), std::invalid_argument);
}

}  // namespace
}  // namespace voxlist
