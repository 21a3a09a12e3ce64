#pragma once

#include <Eigen/Core>
#include <vector>

namespace voxlist::drawing {

/// What is to be seen of one cell of the floor plan.
struct MapColumn {
  Eigen::Vector2i cell;
  /// Height of the highest voxel (m).
  float top_m;
  /// How much of the column is occupied (m).
  float solid_m;
};

/// Cuts a voxel map into columns over a grid of `cell_m` (voxel centres in metres; cells are
/// floor(xy / cell_m)), without what hangs in the air: what is more than 2 m above the floor counts
/// only where it climbs from there by steps of at most 1.2 m and at least three levels of 0.4 m, as
/// walls and pillars do and ceilings do not. Cells of which nothing is left are not in the answer.
std::vector<MapColumn> map_columns(const std::vector<Eigen::Vector3f>& points, double cell_m,
                                   double resolution_m);

}  // namespace voxlist::drawing
