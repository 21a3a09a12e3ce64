#include "voxlist/planning/grids/flood_repair.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "voxlist/planning/grids/cell_array.h"

namespace voxlist::planning {
namespace {

template <class Visit>
void for_each_column(const std::vector<TileChange>& changes, const Visit& visit) {
  for (const TileChange& change : changes)
    for (std::uint64_t left = change.columns; left != 0; left &= left - 1) {
      const int i = std::countr_zero(left);
      visit(change.low + Cell{i % kTileEdge, i / kTileEdge});
    }
}

}  // namespace

void FloodRepair::look(const Cell& cell, Level at) {
  Level& looked_at = cells_.looked_at[cells_.box.index(cell)];
  if (looked_at == at || at == FloodCells::kNone) return;
  looked_at = at;
  if (due_.size() <= at) due_.resize(std::size_t{at} + 1);
  due_[at].push_back(cell);
}

// A bridge ends at most kBridge columns beyond one that it leads over.
void FloodRepair::look_about(const std::vector<TileChange>& changes) {
  std::optional<CellBox> all;
  for_each_column(changes, [&](const Cell& cell) { take_in(all, cell); });
  if (!all) return;
  const CellBox box = common_part(grown(*all, kBridge), cells_.box);
  std::vector<bool> is_near(box.size());
  for_each_column(changes, [&](const Cell& cell) {
    const CellBox about = common_part(grown({cell, cell + Cell{1, 1}}, kBridge), box);
    for (std::int32_t y = about.low.y; y < about.high.y; ++y)
      for (std::int32_t x = about.low.x; x < about.high.x; ++x) is_near[box.index({x, y})] = true;
  });
  for (std::int32_t y = box.low.y; y < box.high.y; ++y)
    for (std::int32_t x = box.low.x; x < box.high.x; ++x)
      if (is_near[box.index({x, y})]) look_about(Cell{x, y});
}

void FloodRepair::look_at_driven(const std::vector<Cell>& cells) {
  for (const Cell& cell : cells)
    if (cells_.box.contains(cell)) look(cell, 0);
}

// What it is reached from may have come or gone.
void FloodRepair::look_about(const Cell& cell) {
  const Level own = level(cell);
  look(cell, own);
  for (const Cell& way : kAround)
    for (std::int32_t steps = 1; steps <= kBridge + 1; ++steps) {
      const Cell from = cell - steps * way;
      if (!cells_.box.contains(from)) break;
      const Level of = level(from);
      if (of != FloodCells::kNone && of + 1 < own && steps_.leads(from, height_m(from), way, steps))
        look(cell, static_cast<Level>(of + 1));
    }
}

// Those that may have been reached from a cell.
void FloodRepair::look_at_followers(const Cell& cell, Level at) {
  for (const Cell& way : kAround)
    for (std::int32_t steps = 1; steps <= kBridge + 1; ++steps) {
      const Cell next = cell + steps * way;
      if (!cells_.box.contains(next)) break;
      if (level(next) == at) look(next, at);
    }
}

// Those that are reached from a cell. A floor that was hit beside it is not looked at once more.
void FloodRepair::look_beyond(const Cell& cell, Level at) {
  const float from_m = height_m(cell);
  for (const Cell& way : kAround) {
    const Cell beside = cell + way;
    if (!cells_.box.contains(beside)) continue;
    const Level of = level(beside);
    if (of != 0 && of + 1 < at && steps_.is_hit_beside(height_m(beside), from_m)) continue;
    steps_.visit_beyond(cell, from_m, way, [&](const Cell& next, float) {
      if (cells_.box.contains(next) && level(next) >= at) look(next, at);
    });
  }
}

// A cell that is no longer reached at its level may be at a higher one.
void FloodRepair::look_again(const Cell& lost, Level from) {
  for (const Cell& way : kAround)
    for (std::int32_t steps = 1; steps <= kBridge + 1; ++steps) {
      const Cell cell = lost - steps * way;
      if (!cells_.box.contains(cell)) break;
      const Level of = level(cell);
      if (of != FloodCells::kNone && of >= from) look(lost, static_cast<Level>(of + 1));
    }
}

std::optional<float> FloodRepair::driven_floor(const Cell& cell) const {
  const std::optional<float> driven_m = driven_.height_m(cell);
  if (!driven_m) return std::nullopt;
  return steps_.driven_floor(cell, *driven_m);
}

std::optional<float> FloodRepair::floor_from_below(const Cell& cell, Level at) {
  std::optional<float> highest_m;
  for (const Cell& way : kAround)
    for (std::int32_t steps = 1; steps <= kBridge + 1; ++steps) {
      const Cell from = cell - steps * way;
      if (!cells_.box.contains(from)) break;
      if (level(from) + 1 != at) continue;
      const auto floor_m = steps_.leads(from, height_m(from), way, steps);
      if (floor_m && (!highest_m || *floor_m > *highest_m)) highest_m = floor_m;
    }
  return highest_m;
}

void FloodRepair::check(const Cell& cell, Level at) {
  const Level own = level(cell);
  if (own < at) return;
  const auto floor_m = at == 0 ? driven_floor(cell) : floor_from_below(cell, at);
  if (floor_m && (own != at || height_m(cell) != *floor_m)) set(cell, at, *floor_m);
  if (!floor_m && own == at) lose(cell);
}

void FloodRepair::set(const Cell& cell, Level at, float floor_m) {
  const Level before = level(cell);
  if (before == FloodCells::kNone || height_m(cell) != floor_m || (before == 0) != (at == 0))
    take_in(changed_, cell);
  level(cell) = at;
  height_m(cell) = floor_m;
  if (before != FloodCells::kNone) look_at_followers(cell, static_cast<Level>(before + 1));
  look_beyond(cell, static_cast<Level>(at + 1));
}

void FloodRepair::lose(const Cell& cell) {
  take_in(changed_, cell);
  const Level before = std::exchange(level(cell), FloodCells::kNone);
  look_at_followers(cell, static_cast<Level>(before + 1));
  look_again(cell, before);
}

std::optional<CellBox> FloodRepair::run() {
  for (std::size_t at = 0; at < due_.size(); ++at) {
    const std::vector<Cell> cells = std::exchange(due_[at], {});
    for (const Cell& cell : cells) {
      Level& looked_at = cells_.looked_at[cells_.box.index(cell)];
      if (looked_at == at) looked_at = FloodCells::kNone;
      check(cell, static_cast<Level>(at));
    }
  }
  return changed_;
}

}  // namespace voxlist::planning
