#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulation/building.h"

namespace voxlist {

/// What a path has to leave room for.
struct TourConfig {
  double robot_radius_m = 0.25;
  double margin_m = 0.12;       ///< beyond the radius: what the robot may stray from the path
  double robot_height_m = 1.0;  ///< higher boxes do not matter; table tops do
  double cell_m = 0.1;          ///< of the grid that the path is searched on
};

/// Plans a closed path: from the origin to the middle of every room and back to the origin. Points
/// are about cell_m apart, keep the radius and margin from every box, and prefer the middle of free
/// space. Throws std::runtime_error when a room cannot be reached.
std::vector<Eigen::Vector2d> plan_tour(const Building& building, const TourConfig& config);

}  // namespace voxlist
