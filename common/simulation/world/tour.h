#pragma once

#include <Eigen/Core>
#include <vector>

#include "voxlist/simulation/building/building.h"
#include "voxlist/simulation/world/path_planner.h"

namespace voxlist::simulation {

/// Plans a closed path: from the origin to the middle of every room and back to the origin. Points
/// are about cell_m apart, keep the radius and margin from every box and hole, and prefer the
/// middle of free space. Throws std::runtime_error when a room cannot be reached.
std::vector<Eigen::Vector2d> plan_tour(const Building& building, const TourConfig& config);

}  // namespace voxlist::simulation
