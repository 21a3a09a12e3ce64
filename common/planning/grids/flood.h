#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "voxlist/planning/grids/driven.h"
#include "voxlist/planning/grids/floor_columns.h"
#include "voxlist/planning/grids/floor_steps.h"

namespace voxlist::planning {

/// What a flood has reached, cell by cell.
struct FloodCells {
  using Level = std::uint16_t;
  static constexpr Level kNone = 0xFFFF;

  CellBox box;
  std::vector<Level> levels;     ///< steps from where one drove; kNone: not reached
  std::vector<float> height_m;   ///< of the floor, where it is reached
  std::vector<Level> looked_at;  ///< scratch of FloodRepair: kNone everywhere between two repairs
};

/// The floor that a robot gets to over steps of a height, from where one has driven: any number of
/// ramps and heights, one above each place of the floor plan. Where floors lie above each other it
/// is the one that fewest steps lead to, and of several such the highest. So it is told by columns
/// and driven cells alone, whatever the order in which they came: what has changed is flooded
/// again, and all that hangs on it, with the result of a flood of all.
class Flood {
 public:
  explicit Flood(double step_m) : step_m_(step_m) {}

  /// Follows columns that have changed and cells that were driven since; those that lie where the
  /// columns' bounds have grown are to be told once more. Cells in the box that comes back may have
  /// another floor than before; none: all have the same.
  std::optional<CellBox> follow(const FloorColumns& columns, const std::vector<TileChange>& changes,
                                const DrivenCells& driven, const std::vector<Cell>& driven_changes);

  double step_m() const { return step_m_; }

  bool is_reached(const Cell& cell) const {
    return cells_.box.contains(cell) && cells_.levels[cells_.box.index(cell)] != FloodCells::kNone;
  }
  bool is_driven(const Cell& cell) const { return cells_.levels[cells_.box.index(cell)] == 0; }
  float height_m(const Cell& cell) const { return cells_.height_m[cells_.box.index(cell)]; }

  std::size_t memory_bytes() const {
    return cells_.levels.capacity() * (2 * sizeof(FloodCells::Level) + sizeof(float));
  }

 private:
  CellBox begin(const FloorColumns& columns, const DrivenCells& driven,
                const std::vector<Cell>& driven_cells);
  std::vector<Cell> flood_on(const FloorSteps& steps, const std::vector<Cell>& edge);

  double step_m_;
  FloodCells cells_;
  bool has_begun_ = false;
};

}  // namespace voxlist::planning
