#pragma once

#include <Eigen/Core>
#include <vector>

#include "tests/bench/ramps/slab_world.h"

namespace voxlist::bench {

/// A block that stands upright, between two of its corners.
Slab block(const Eigen::Vector3d& low, const Eigen::Vector3d& high);

/// A plate along x whose upper face goes from one height to another.
Slab flight(double from_x, double to_x, double y0, double y1, double from_z, double to_z);

/// A robot that stands at a place; `above_m`: a height from which the ground is the next thing
/// below.
Pose3 standing(const SlabWorld& world, const Pose2& place, double above_m);

/// Where a drive turns, and a height from which the ground there is the next thing below.
struct Stop {
  Eigen::Vector2d at;
  double above_m;
};

/// A drive from stop to stop: poses no more than `step_m` and 20 deg apart.
std::vector<Pose3> drive_along(const SlabWorld& world, const std::vector<Stop>& way, double step_m);

}  // namespace voxlist::bench
