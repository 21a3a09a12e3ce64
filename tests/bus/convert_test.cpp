#include "voxlist/bus/convert.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <voxlist/keyframe_t.hpp>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_hint_t.hpp>
#include <voxlist/pose_t.hpp>

namespace voxlist::bus {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

Cloud two_points() {
  Cloud cloud;
  cloud.utime_us = 9;
  cloud.points = {{1, 2, 3}, {4, 5, 6}};
  cloud.origins = {{0, 0, 1}, {0, 0.5F, 1}};
  return cloud;
}

Pose3 some_pose() {
  const Eigen::AngleAxisd turn(0.7, Eigen::Vector3d(1, 2, 3).normalized());
  return Eigen::Translation3d(1, -2, 3) * turn;
}

TEST(CloudMessage, KeepsPointsAndOrigins) {
  const pointcloud_t message = to_message(two_points(), "base", 7);
  EXPECT_EQ(message.seq, 7);
  EXPECT_EQ(message.frame_id, "base");
  EXPECT_EQ(message.n_channels, 3);
  const ReceivedCloud received = from_message(message);
  ASSERT_TRUE(received.cloud);
  EXPECT_EQ(received.cloud->utime_us, 9);
  EXPECT_EQ(received.cloud->points, two_points().points);
  EXPECT_EQ(received.cloud->origins, two_points().origins);
  EXPECT_EQ(received.dropped_points, 0);
}

TEST(CloudMessage, HasNoChannelsWithoutOriginsAndIgnoresOthers) {
  Cloud cloud = two_points();
  cloud.origins.clear();
  pointcloud_t message = to_message(cloud, "base", 0);
  EXPECT_EQ(message.n_channels, 0);
  message.n_channels = 1;
  message.channel_names = {"intensity"};
  message.channels = {{1, 2}};
  const ReceivedCloud received = from_message(message);
  ASSERT_TRUE(received.cloud);
  EXPECT_TRUE(received.cloud->origins.empty());
}

TEST(CloudMessage, DropsAndCountsWhatIsNoMeasurement) {
  Cloud cloud;
  cloud.points = {{kNan, 0, 0}, {0, kInfinity, 0}, {0, 0, -20'000}, {1, 1, 1}, {2, 2, 2}};
  cloud.origins = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, kNan, 0}, {0, 0, 3}};
  const ReceivedCloud received = from_message(to_message(cloud, "base", 0));
  ASSERT_TRUE(received.cloud);
  EXPECT_EQ(received.dropped_points, 4);
  EXPECT_EQ(received.cloud->points, (std::vector<Eigen::Vector3f>{{2, 2, 2}}));
  EXPECT_EQ(received.cloud->origins, (std::vector<Eigen::Vector3f>{{0, 0, 3}}));
}

TEST(CloudMessage, IsRefusedWithAReasonWhenItContradictsItself) {
  const pointcloud_t good = to_message(two_points(), "base", 0);
  pointcloud_t bad = good;
  bad.channel_names[1] = "something";
  EXPECT_EQ(from_message(bad).refusal, "partial_origins");
  bad = good;
  bad.channel_names[1] = "origin_x";
  EXPECT_EQ(from_message(bad).refusal, "repeated_channel");
  bad = good;
  bad.channels[2].pop_back();
  EXPECT_EQ(from_message(bad).refusal, "ragged_arrays");
  bad = good;
  bad.utime = -1;
  EXPECT_EQ(from_message(bad).refusal, "bad_utime");
  EXPECT_FALSE(from_message(bad).cloud);
}

TEST(PoseMessage, KeepsThePose) {
  const auto received = from_message(to_message(StampedPose3{5, some_pose()}));
  ASSERT_TRUE(received);
  EXPECT_EQ(received->utime_us, 5);
  EXPECT_TRUE(received->pose.isApprox(some_pose(), 1e-12));
}

TEST(PoseMessage, HoldsAPlanarPoseToo) {
  const Pose2 pose{1.0, 2.0, -3 * std::numbers::pi / 4};
  const pose_t message = to_message(StampedPose2{5, pose});
  EXPECT_NEAR(std::hypot(message.orientation[0], message.orientation[3]), 1.0, 1e-12);
  const auto received = from_message(message);
  ASSERT_TRUE(received);
  EXPECT_NEAR(to_pose2(received->pose).yaw_rad, pose.yaw_rad, 1e-12);
}

TEST(PoseMessage, NormalisesASinglePrecisionQuaternion) {
  pose_t message = to_message(StampedPose3{5, some_pose()});
  for (double& q : message.orientation) q *= 1.0005;
  const auto received = from_message(message);
  ASSERT_TRUE(received);
  EXPECT_NEAR(received->pose.linear().determinant(), 1.0, 1e-12);
}

TEST(PoseMessage, IsRefusedWhenItIsNoPose) {
  const pose_t good = to_message(StampedPose3{5, some_pose()});
  pose_t bad = good;
  bad.pos[1] = std::nan("");
  EXPECT_FALSE(from_message(bad));
  bad = good;
  bad.pos[2] = 1e9;
  EXPECT_FALSE(from_message(bad));
  bad = good;
  for (double& q : bad.orientation) q = 0.0;
  EXPECT_FALSE(from_message(bad));
  bad.orientation[0] = std::nan("");
  EXPECT_FALSE(from_message(bad));
  bad = good;
  bad.utime = std::numeric_limits<std::int64_t>::min();
  EXPECT_FALSE(from_message(bad));
}

TEST(KeyframeMessage, KeepsCloudPoseAndPlace) {
  const auto received = from_message(to_message(PosedCloud{77, 3, some_pose(), two_points()}));
  ASSERT_TRUE(received);
  EXPECT_EQ(received->map_id, 77);
  EXPECT_EQ(received->index, 3);
  EXPECT_TRUE(received->T_map_base.isApprox(some_pose(), 1e-12));
  EXPECT_EQ(received->cloud.utime_us, 9);
  EXPECT_EQ(received->cloud.points, two_points().points);
  EXPECT_EQ(received->cloud.origins, two_points().origins);
}

TEST(KeyframeMessage, IsRefusedWhenItContradictsItself) {
  const keyframe_t good = to_message(PosedCloud{77, 3, some_pose(), two_points()});
  keyframe_t bad = good;
  bad.origins.pop_back();
  EXPECT_FALSE(from_message(bad));
  bad = good;
  bad.index = -1;
  EXPECT_FALSE(from_message(bad));
  bad = good;
  bad.quat[0] = 2.0;
  EXPECT_FALSE(from_message(bad));
}

TEST(PoseHintMessage, IsAPoseWithItsDoubtOrNothing) {
  pose_hint_t message{};
  message.pose[0] = 3.0;
  message.pose[2] = 7.0;
  message.sigma_m = 0.5;
  message.sigma_rad = 0.2;
  const auto hint = from_message(message);
  ASSERT_TRUE(hint);
  EXPECT_EQ(hint->pose.x_m, 3.0);
  EXPECT_NEAR(hint->pose.yaw_rad, 7.0 - 2.0 * std::numbers::pi, 1e-12);
  EXPECT_NEAR(hint->covariance(1, 1), 0.25, 1e-12);
  EXPECT_NEAR(hint->covariance(2, 2), 0.04, 1e-12);
  for (double* field : {&message.pose[1], &message.pose[2], &message.sigma_m, &message.sigma_rad}) {
    const double before = *field;
    for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
      *field = bad;
      EXPECT_FALSE(from_message(message));
    }
    *field = before;
  }
  message.sigma_m = 0.0;
  EXPECT_FALSE(from_message(message));
}

}  // namespace
}  // namespace voxlist::bus
