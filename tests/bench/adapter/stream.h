#pragma once

#include <cstdint>
#include <string>
#include <vector>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_t.hpp>

#include "tests/simulation/swept_laser.h"
#include "voxlist/simulation/world/trajectory.h"

namespace voxlist::bench {

/// A laser whose driver publishes whole sweeps, and how.
struct StreamKind {
  std::string name;
  simulation::SweptLaser laser;
};

/// The kinds that are measured.
std::vector<StreamKind> stream_kinds();

/// What a robot's laser and wheels say while it drives through a building at 1 m/s and 60 deg/s.
struct Stream {
  simulation::Trajectory drive;
  std::vector<pointcloud_t> clouds;  ///< utime: after the drive's start
  std::vector<pose_t> odometry;
};

/// Sweeps without a pause for so long.
Stream make_stream(const StreamKind& kind, double seconds, std::uint64_t seed);

/// The robot's settings for it, with the map in memory.
std::string settings_of(const StreamKind& kind);

/// The channel that the laser speaks on.
inline constexpr char kLaserChannel[] = "LASER_3D";

}  // namespace voxlist::bench
