#pragma once

#include <Eigen/Core>
#include <vector>

#include "voxlist/planning/grids/floor_columns.h"

namespace voxlist::planning {

/// A column that the robot stood on, and the height of its floor there.
struct DrivenCell {
  Cell cell;
  float height_m = 0.0F;
};

/// Half the width of what a robot is known to have driven over, whatever its size (m).
inline constexpr double kDriven_m = 0.15;

/// Positions that follow each other within this are joined by the way between them (m).
inline constexpr double kDrivenStep_m = 1.0;

/// How far the floor is above or below base's origin along a way (m): 0 where floors are seen at
/// base's own height, as they should be. Scans that are told in the scanner's frame have it below:
/// where nearly none is at that height, but at another one, that is what most columns about the
/// way say. Looks at 100 places of the way at most.
float floor_under_base_m(const FloorColumns& columns, const std::vector<Eigen::Vector3d>& way);

/// The columns along a way, given by positions of base in the map: base is on the floor under the
/// robot. A cell may be told more than once.
std::vector<DrivenCell> driven_cells(const std::vector<Eigen::Vector3d>& way);

}  // namespace voxlist::planning
