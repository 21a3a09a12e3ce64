#include "voxlist/planning/grids/ground.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "voxlist/planning/grids/cell_array.h"

namespace voxlist::planning {
namespace {

// Calls visit(cell) for each cell of a box, x first.
template <class Visit>
void for_each_cell(const CellBox& box, const Visit& visit) {
  for (std::int32_t y = box.low.y; y < box.high.y; ++y)
    for (std::int32_t x = box.low.x; x < box.high.x; ++x) visit(Cell{x, y});
}

// The height at which a floor goes on over a cell along a line of cells, from the side that `way`
// leads away from.
std::optional<float> bridged_m(const FloorSteps& steps, const Flood& flood, const Cell& cell,
                               const Cell& way) {
  for (std::int32_t gap = 1; gap <= kBridge; ++gap)
    for (std::int32_t k = 1; k <= gap; ++k) {
      const Cell from = cell - k * way, beyond = from + (gap + 1) * way, other = from + way;
      if (!flood.is_reached(from) || !flood.is_reached(beyond)) continue;
      if (gap > 1 && flood.is_reached(other == cell ? cell + way : other)) continue;
      const float from_m = flood.height_m(from);
      if (std::abs(flood.height_m(beyond) - from_m) > steps.step_m()) continue;
      if (steps.is_bridged(from, from_m, way, gap)) return from_m;
    }
  return std::nullopt;
}

}  // namespace

Ground::Ground(const FloorColumns& columns, const Flood& flood, const CellBox& box)
    : box_(common_part(box, *columns.bounds())),
      whole_(common_part(grown(box, kGroundMargin), *columns.bounds())),
      footing_(whole_.size(), Footing::kNone),
      height_m_(whole_.size(), 0.0F) {
  take(flood);
  bridge(FloorSteps(columns, flood.step_m()), flood);
  reach_on();
}

void Ground::put(const Cell& cell, Footing footing, float height_m) {
  footing_[whole_.index(cell)] = footing;
  height_m_[whole_.index(cell)] = height_m;
}

void Ground::take(const Flood& flood) {
  for_each_cell(whole_, [&](const Cell& cell) {
    if (flood.is_reached(cell))
      put(cell, flood.is_driven(cell) ? Footing::kDriven : Footing::kSeen, flood.height_m(cell));
  });
}

// Of several heights the highest.
void Ground::bridge(const FloorSteps& steps, const Flood& flood) {
  for_each_cell(whole_, [&](const Cell& cell) {
    if (footing(cell) >= Footing::kSeen) return;
    for (const Cell& way : kAround) {
      const auto from_m = bridged_m(steps, flood, cell, way);
      if (from_m && (footing(cell) != Footing::kBridged || *from_m > height_m(cell)))
        put(cell, Footing::kBridged, *from_m);
    }
  });
}

// The height of the floor beyond its edge.
void Ground::reach_on() {
  const auto is_at_edge = [&](const Cell& cell) {
    return std::ranges::any_of(kAround, [&](const Cell& way) {
      return whole_.contains(cell + way) && footing(cell + way) < Footing::kBridged;
    });
  };
  std::vector<Cell> level;
  for_each_cell(whole_, [&](const Cell& cell) {
    if (footing(cell) >= Footing::kBridged && is_at_edge(cell)) level.push_back(cell);
  });
  constexpr auto kLevels = static_cast<std::uint8_t>(kReach_m / kColumn_m);
  std::vector<std::uint8_t> reached(whole_.size(), 0);
  for (std::uint8_t i = 1; i <= kLevels && !level.empty(); ++i) {
    std::vector<Cell> next;
    for (const Cell& from : level)
      for (const Cell& way : kAround) {
        const Cell cell = from + way;
        if (!whole_.contains(cell) || footing(cell) >= Footing::kBridged) continue;
        std::uint8_t& at = reached[whole_.index(cell)];
        if (at != 0 && at != i) continue;
        const float highest_m = at == 0 ? height_m(from) : std::max(height_m(from), height_m(cell));
        if (at == 0) next.push_back(cell);
        at = i;
        put(cell, Footing::kNear, highest_m);
      }
    level = std::move(next);
  }
}

}  // namespace voxlist::planning
