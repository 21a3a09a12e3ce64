#pragma once

#include <cstdint>

#include "voxlist/geometry/cloud.h"
#include "voxlist/geometry/pose.h"
#include "voxlist/simulation/world/world.h"

namespace voxlist::simulation {

/// A laser that sees all round: rays from one place, all at once, spread evenly up and down, or in
/// rings.
struct SphereScanConfig {
  int rays = 64'000;
  int rings = 0;               ///< of rays / rings rays each; 0: no rings
  double rings_to_deg = 15.0;  ///< the highest ring's elevation, and the lowest one's downwards
  double height_m = 1.0;       ///< above the floor
  double range_min_m = 0.3;
  double range_max_m = 30.0;
  double range_sd_m = 0.015;
};

/// The scan from a pose, in base: at most one point for each ray, with noise along it; floor and
/// ceiling are in it. The rays are the same for every scan (a Fibonacci lattice, or rings), the
/// noise depends on the seed.
Cloud scan_sphere(const World& world, const Pose2& T_map_base, const SphereScanConfig& config,
                  std::uint64_t seed);

}  // namespace voxlist::simulation
