#pragma once

#include <cstdint>
#include <string>

#include "voxlist/adapter/adapter_config.h"

namespace voxlist::bench {

/// A 3D laser on a robot.
struct Mounted {
  double roll_deg = 0.0, pitch_deg = 0.0, yaw_deg = 0.0;
  double x_m = 0.0, y_m = 0.0, z_m = 1.0;
  double latency_ms = 0.0;  ///< of its messages' times
  int rays = 7'200;         ///< of a sweep
};

/// Writes the log of a drive through a simulated building: LASER_3D at 10 Hz (16 rings, time of
/// each point, noise of 10 mm), ODOMETRY at 50 Hz with what wheels are off by.
void write_drive(const std::string& log, const Mounted& laser, double seconds, std::uint64_t seed);

}  // namespace voxlist::bench
