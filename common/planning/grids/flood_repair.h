#pragma once

#include <optional>
#include <vector>

#include "voxlist/planning/grids/flood.h"
#include "voxlist/planning/grids/floor_steps.h"

namespace voxlist::planning {

/// Brings a flood up to date, level by level from where one drove: when a level is done, its cells
/// and all of lower levels are what a flood of all would make of them. Only cells are looked at
/// that changed themselves, or that a changed one leads to or has led to.
class FloodRepair {
 public:
  FloodRepair(FloodCells& cells, const FloorColumns& columns, const DrivenCells& driven,
              double step_m)
      : cells_(cells), driven_(driven), steps_(columns, step_m) {}

  /// Columns that changed are to be looked at, and those that are reached over them.
  void look_about(const std::vector<TileChange>& changes);

  /// Cells that were driven, or no longer count as such.
  void look_at_driven(const std::vector<Cell>& cells);

  /// The cells that got another floor, or none, lie in this box.
  std::optional<CellBox> run();

 private:
  using Level = FloodCells::Level;

  Level& level(const Cell& cell) { return cells_.levels[cells_.box.index(cell)]; }
  float& height_m(const Cell& cell) { return cells_.height_m[cells_.box.index(cell)]; }
  void look(const Cell& cell, Level at);
  void look_about(const Cell& cell);
  void look_at_followers(const Cell& cell, Level at);
  void look_beyond(const Cell& cell, Level at);
  void look_again(const Cell& lost, Level from);
  void check(const Cell& cell, Level at);
  void set(const Cell& cell, Level at, float floor_m);
  void lose(const Cell& cell);
  std::optional<float> driven_floor(const Cell& cell) const;
  std::optional<float> floor_from_below(const Cell& cell, Level at);

  FloodCells& cells_;
  const DrivenCells& driven_;
  const FloorSteps steps_;
  std::vector<std::vector<Cell>> due_;  // by level
  std::optional<CellBox> changed_;
};

}  // namespace voxlist::planning
