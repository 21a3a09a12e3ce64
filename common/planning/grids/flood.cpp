#include "voxlist/planning/grids/flood.h"

#include <algorithm>

#include "voxlist/planning/grids/cell_array.h"
#include "voxlist/planning/grids/flood_repair.h"

namespace voxlist::planning {

std::optional<CellBox> Flood::follow(const FloorColumns& columns,
                                     const std::vector<TileChange>& changes,
                                     const DrivenCells& driven,
                                     const std::vector<Cell>& driven_changes) {
  if (!columns.bounds()) return std::nullopt;
  const CellBox& box = *columns.bounds();
  if (cells_.box != box) {
    cells_.levels = relaid(cells_.box, cells_.levels, box, FloodCells::kNone);
    cells_.height_m = relaid(cells_.box, cells_.height_m, box, 0.0F);
    cells_.looked_at.assign(box.size(), FloodCells::kNone);
    cells_.box = box;
  }
  if (!has_begun_) return begin(columns, driven, driven_changes);
  FloodRepair repair(cells_, columns, driven, step_m_);
  repair.look_about(changes);
  repair.look_at_driven(driven_changes);
  return repair.run();
}

// What FloodRepair would come to, without looking back: a third of the time. What was known before
// is none of this flood's: any cell may have another floor than it had.
CellBox Flood::begin(const FloorColumns& columns, const DrivenCells& driven,
                     const std::vector<Cell>& driven_cells) {
  const FloorSteps steps(columns, step_m_);
  std::vector<Cell> edge;
  for (const Cell& cell : driven_cells) {
    const auto driven_m = driven.height_m(cell);
    if (!driven_m || !cells_.box.contains(cell) || is_reached(cell)) continue;
    cells_.levels[cells_.box.index(cell)] = 0;
    cells_.height_m[cells_.box.index(cell)] = steps.driven_floor(cell, *driven_m);
    edge.push_back(cell);
  }
  has_begun_ = !edge.empty();
  while (!edge.empty()) edge = flood_on(steps, edge);
  return cells_.box;
}

// The cells of the next level.
std::vector<Cell> Flood::flood_on(const FloorSteps& steps, const std::vector<Cell>& edge) {
  std::vector<Cell> next;
  const auto at = static_cast<FloodCells::Level>(cells_.levels[cells_.box.index(edge.front())] + 1);
  for (const Cell& from : edge) {
    const float from_m = height_m(from);
    for (const Cell& way : kAround) {
      const Cell beside = from + way;
      if (!cells_.box.contains(beside)) continue;
      const FloodCells::Level of = cells_.levels[cells_.box.index(beside)];
      if (of != 0 && of < at && steps.is_hit_beside(height_m(beside), from_m)) continue;
      steps.visit_beyond(from, from_m, way, [&](const Cell& cell, float floor_m) {
        if (!cells_.box.contains(cell)) return;
        FloodCells::Level& level = cells_.levels[cells_.box.index(cell)];
        float& highest_m = cells_.height_m[cells_.box.index(cell)];
        if (level < at) return;
        if (level == FloodCells::kNone) next.push_back(cell);
        highest_m = level == FloodCells::kNone ? floor_m : std::max(highest_m, floor_m);
        level = at;
      });
    }
  }
  return next;
}

}  // namespace voxlist::planning
