#pragma once

#include <Eigen/Core>
#include <vector>

#include "voxlist/simulation/building/building.h"
#include "voxlist/simulation/world/path_planner.h"

namespace voxlist::simulation {

/// Which rooms of a building a robot visits that shares it with others: each has as many, next to
/// each other along the corridor.
struct TourShare {
  int robots = 1;
  int robot = 0;  ///< from 0
};

/// Plans a closed path: from the origin to the middle of every room and back to the origin. Points
/// are about cell_m apart, keep the radius and margin from every box and hole, and prefer the
/// middle of free space. With a share it starts in the corridor before the first of its rooms.
/// Throws std::runtime_error when a room cannot be reached, std::invalid_argument when there are
/// fewer rooms than robots, or no such robot.
std::vector<Eigen::Vector2d> plan_tour(const Building& building, const TourConfig& config,
                                       const TourShare& share = {});

}  // namespace voxlist::simulation
