#pragma once

#include <Eigen/Core>
#include <vector>

#include "voxlist/simulation/building/building.h"
#include "voxlist/simulation/world/path_planner.h"

namespace voxlist::simulation {

/// Where in the tour of a building a robot begins that shares it with others, who drive the same
/// tour at the same time: as many rooms apart as there are robots.
struct TourShare {
  int robots = 1;
  int robot = 0;  ///< from 0
};

/// Plans a closed path: from the origin to the middle of every room and back to the origin. Points
/// are about cell_m apart, keep the radius and margin from every box and hole, and prefer the
/// middle of free space. Of several robots each starts in the corridor before its first room.
/// Throws std::runtime_error when a room cannot be reached, std::invalid_argument when there are
/// fewer rooms than robots, or no such robot.
std::vector<Eigen::Vector2d> plan_tour(const Building& building, const TourConfig& config,
                                       const TourShare& share = {});

}  // namespace voxlist::simulation
