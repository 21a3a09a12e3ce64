#pragma once

#include <cstdint>
#include <vector>

#include "voxlist/geometry/pose.h"
#include "voxlist/geometry/tilt.h"

namespace voxlist::bench {

/// A drive, and what the robot measures on it.
struct RampDrive {
  std::vector<Pose3> truth;
  /// Wheels measure the way along the slope, up to 2 % off, and drift by up to 0.01 rad/m.
  std::vector<Pose2> T_odom_base;
  /// Roll and pitch, 0.3 deg off at random.
  std::vector<Tilt> odometry_tilt;
};

RampDrive ramp_drive(std::vector<Pose3> truth, std::uint64_t seed);

}  // namespace voxlist::bench
