#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "voxlist/simulation/world/trajectory.h"

namespace voxlist::simulation {

/// How the robot drives.
struct DriveConfig {
  double speed_max_mps = 0.6;
  double acceleration_max_mps2 = 0.5;
  double turn_rate_max_dps = 45.0;
  double turn_acceleration_max_dps2 = 90.0;
  double lookahead_m = 0.35;  ///< it steers for the path's point this far ahead: more cuts corners
  double period_s = 0.01;     ///< of the motion's steps
  double wait_s = 0.0;        ///< it stands at its start for so long
};

/// Errors of the wheels' measure. Scales are drawn once for a seed, noise grows with the root of
/// what was driven, as a random walk does.
struct OdometryConfig {
  double rate_hz = 50.0;
  double distance_scale_sd = 0.01;
  double turn_scale_sd = 0.01;
  double distance_noise_m = 0.005;  ///< standard deviation after 1 m
  double heading_noise_deg = 0.5;   ///< standard deviation after 1 m
};

/// Drives a path as a differential-drive robot does, from rest at its first point with heading 0 to
/// rest at its last, turned back to heading 0. Poses are in the path's frame.
Trajectory drive(const std::vector<Eigen::Vector2d>& path, const DriveConfig& config);

/// What the wheels measure of a motion: T_odom_base, which starts at the identity and drifts.
Trajectory wheel_odometry(const Trajectory& truth, const OdometryConfig& config,
                          std::uint64_t seed);

}  // namespace voxlist::simulation
