#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "voxlist/geometry/odometry_buffer.h"
#include "voxlist/geometry/pose.h"

namespace voxlist::adapter {

/// Where odometry says that the robot was, in space: the plane's part by OdometryBuffer's rules,
/// height, roll and pitch evenly between two measurements, and held after the newest.
class RobotMotion {
 public:
  void add(const StampedPose3& T_odom_base);

  /// T_odom_base at a time. Nothing where OdometryBuffer::estimate knows nothing.
  std::optional<Pose3> at(std::int64_t utime_us, std::int64_t max_extrapolation_us) const;

  std::optional<std::int64_t> newest_utime_us() const { return plane_.newest_utime_us(); }

 private:
  // What T_odom_base has beside its plane's part.
  struct Tilt {
    std::int64_t utime_us;
    double z_m;
    Eigen::Quaterniond turn;
  };

  Tilt tilt_at(std::int64_t utime_us) const;

  OdometryBuffer plane_;
  std::deque<Tilt> tilts_;  // by time; as many as the plane has
};

/// The same place and heading, but level.
Pose3 levelled(const Pose3& T_odom_base);

}  // namespace voxlist::adapter
