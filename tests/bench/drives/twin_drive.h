#pragma once

#include <optional>
#include <set>
#include <vector>

#include "voxlist/geometry/pose.h"
#include "voxlist/simulation/world/world.h"

namespace voxlist::bench {

/// A drive from office to office of a wing and back to where it began, a keyframe each metre, by
/// wheels that are off by 2 % of the way and 1 deg at each metre.
struct TwinDrive {
  std::vector<Pose2> truth;        ///< T_map_base
  std::vector<Pose2> T_odom_base;  ///< the first one is right
  std::set<std::size_t> blind;     ///< keyframes that see nothing
};

/// A wing of that many offices, of which none can be told from another, along a bare corridor.
simulation::Building twin_offices(int rooms, int seed);

/// `blind`: on 8 m in its middle nothing is seen, and wheels alone tell how it went on. Equal
/// arguments give equal bits.
TwinDrive twin_drive(const simulation::Building& building, bool blind, int seed);

}  // namespace voxlist::bench
