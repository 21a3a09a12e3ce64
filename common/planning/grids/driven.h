#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <utility>
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
std::vector<DrivenCell> driven_cells(std::span<const Eigen::Vector3d> way);

/// All columns that a robot stood on, each with the lowest height at which it did. The map's
/// origin, where its first cloud was taken, is always one of them.
class DrivenCells {
 public:
  DrivenCells() { forget(); }

  /// Takes the ways that were driven; what goes on where one before ended costs its new part alone.
  /// False: they do not go on, and all begins anew.
  bool drive(const std::vector<std::vector<Eigen::Vector3d>>& ways);

  /// The floor's height above or below base's (floor_under_base_m).
  void set_floor_m(float floor_m);

  /// The floor's height; none where nobody drove.
  std::optional<float> height_m(const Cell& cell) const;

  /// Lets the next take_changes() tell all cells.
  void change_all();

  /// Cells that are new, that are none any more, or whose height has changed, since the last call.
  std::vector<Cell> take_changes() { return std::exchange(changes_, {}); }

 private:
  void forget();
  void add(std::span<const Eigen::Vector3d> way);

  std::vector<std::vector<Eigen::Vector3d>> ways_;
  Numbering<Voxel> cells_;  // z = 0
  std::vector<float> height_m_;
  float floor_m_ = 0.0F;
  std::vector<Cell> changes_;
};

}  // namespace voxlist::planning
