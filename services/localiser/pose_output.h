#pragma once

#include <cstdint>
#include <optional>

#include "voxlist/geometry/cloud.h"
#include "voxlist/geometry/tilt.h"
#include "voxlist/geometry/uncertain_pose.h"

namespace voxlist::bus {
class Bus;
}

namespace voxlist::services {

/// POSE, POSE_COVARIANCE and T_MAP_ODOM: where the robot is, only while it is TRACKING.
class PoseOutput {
 public:
  /// The cloud that a pose was found by, and the map that it was found in.
  struct Found {
    std::int64_t utime_us = 0;
    std::int64_t map_id = 0;
    std::int64_t map_version = 0;
  };

  explicit PoseOutput(bus::Bus& bus) : bus_(bus) {}

  /// A cloud's pose is sure. `tilt`: what T_map_base leaves out; it stays until the next cloud.
  /// `T_odom_base`: odometry at that time, if there is any.
  void found(const Found& cloud, const UncertainPose& T_map_base, const Tilt& tilt,
             const std::optional<Pose2>& T_odom_base);

  /// The map was moved: poses from now on are in the map since.
  void jump(const Pose2& T_new_old);

  /// Nothing is sure any more, until the next call of found().
  void lose();

  /// The pose by odometry since the cloud; nothing when it is not known.
  std::optional<Pose2> at(const Pose2& T_odom_base) const;

  /// Publishes a pose of odometry's time. Precondition: at() knows it.
  void publish(std::int64_t utime_us, const UncertainPose& T_map_base);

 private:
  void publish_pose(std::int64_t utime_us, const Pose2& pose);

  bus::Bus& bus_;
  Found cloud_;
  Tilt tilt_;
  std::optional<Pose2> T_map_odom_;
  std::optional<StampedPose2> last_pose_;
};

}  // namespace voxlist::services
