#pragma once

#include <Eigen/Core>
#include <vector>

namespace voxlist::drawing {

/// One cell of the floor plan, with the voxels that stand above it.
struct MapColumn {
  Eigen::Vector2i cell;
  /// Height of the highest voxel (m).
  float top_m;
  /// How much of the column is occupied (m).
  float solid_m;
};

/// Cuts a voxel map into columns over a grid of `cell_m`; `points` are the centres of voxels of
/// edge `resolution_m` (m), and a point's cell is floor(xy / cell_m).
///
/// Ceilings are left out. A voxel that is more than 2 m above the floor stays only where a wall or
/// a pillar reaches up to it: at least three levels of 0.4 m with no gap of more than 1.2 m. A cell
/// of which nothing is left is not in the answer.
std::vector<MapColumn> map_columns(const std::vector<Eigen::Vector3f>& points, double cell_m,
                                   double resolution_m);

}  // namespace voxlist::drawing
