#pragma once

#include <cstdint>
#include <vector>

#include "voxlist/adapter/adapter_config.h"
#include "voxlist/adapter/raw_cloud.h"
#include "voxlist/geometry/cloud.h"

namespace voxlist::adapter::test {

inline constexpr std::int64_t kStart_us = 1'700'000'000'000'000;

/// A robot that drives at 1 m/s and turns by 60 deg/s, rolling and pitching by so much.
struct DrivingRobot {
  double tilt_deg = 0.0;

  /// So long after kStart_us.
  Pose3 T_odom_base(double t_s) const;
};

/// A laser of 16 rings that turns ten times a second. Its points lie 1 to 21 m away.
struct SpinningLaser {
  SensorConfig sensor;
  int columns = 450;

  /// The sweep from a time on, with its points' times from zero on in seconds; utime is its start.
  RawCloud sweep(double start_s) const;

  /// Where its points are, in odom, in their order.
  std::vector<Eigen::Vector3d> truth(const DrivingRobot& robot, double start_s) const;
};

/// A laser somewhere on a robot, tilted, that tells its points' times.
SpinningLaser tilted_laser();

/// The greatest distance of a cloud's points from these, seen from T_odom_cloud; infinite when they
/// are not as many.
double greatest_error_m(const Cloud& cloud, const std::vector<Eigen::Vector3d>& truth_odom,
                        const Pose3& T_odom_cloud);

}  // namespace voxlist::adapter::test
