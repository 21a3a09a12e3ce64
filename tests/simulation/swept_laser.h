#pragma once

#include <cstdint>
#include <vector>

#include "voxlist/geometry/pose.h"
#include "voxlist/simulation/world/trajectory.h"
#include "voxlist/simulation/world/world.h"

namespace voxlist::simulation {

/// A 3D laser on a robot that drives: each ray starts where the robot is then.
struct SweptLaser {
  int rays = 30'000;  ///< of a sweep
  int rings = 16;     ///< that turn clockwise from behind; 0: a rosette that never repeats
  double low_deg = -15.0, high_deg = 15.0;  ///< elevations; of a rosette: half its cone
  double sweep_s = 0.1;
  double range_max_m = 100.0;
  double range_sd_m = 0.01;
  Pose3 T_base_laser = Pose3::Identity();
};

/// What came back of a sweep, in the order of time.
struct LaserSweep {
  std::vector<Eigen::Vector3f> points;  ///< in the laser's frame
  std::vector<float> after_s;           ///< when each was measured, after the sweep's start
  std::vector<float> rings;             ///< from 0, the lowest first
};

/// The sweep that begins at a time of the drive, with noise along each ray by the seed.
LaserSweep sweep(const World& world, const Trajectory& drive, const SweptLaser& laser,
                 double start_s, std::uint64_t seed);

}  // namespace voxlist::simulation
