#include "voxlist/planning/grids/ground.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace voxlist::planning {
namespace {

constexpr std::array<Cell, 8> kAround = {
    {{-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-1, -1}, {1, 1}, {-1, 1}, {1, -1}}};

// What noise leaves of the height of a column's surface, and half a voxel (m): steps are told apart
// to so much.
constexpr float kSlack_m = 0.01F;

// A gap between rays of so many columns is bridged where the floor was hit on both sides: 0.16 m.
// A hole of 0.3 m is wider.
constexpr std::int32_t kBridge = 2;

// A floor that was not hit: a ray passed so close above it (m), and none in a cell below.
constexpr double kCloseAbove_m = 0.16, kBelow_m = 0.04;

// Under a floor the robot's height is off by less than this where it drove (m).
constexpr float kPoseError_m = 0.05F;

Cell operator+(const Cell& a, const Cell& b) { return {a.x + b.x, a.y + b.y}; }

Cell times(const Cell& way, std::int32_t steps) { return {way.x * steps, way.y * steps}; }

}  // namespace

Ground::Ground(const FloorColumns& columns, const std::vector<DrivenCell>& driven, double step_m)
    : columns_(columns),
      step_m_(static_cast<float>(step_m)),
      box_(*columns.bounds()),
      footing_(box_.size(), Footing::kNone),
      height_m_(box_.size(), 0.0F) {
  start(driven);
  flood();
  reach_on();
}

void Ground::put(const Cell& cell, Footing footing, float height_m) {
  footing_[box_.index(cell)] = footing;
  height_m_[box_.index(cell)] = height_m;
}

// The surface next to a height that a step leads to; none where there is a kerb in the column.
std::optional<float> Ground::floor_at(const Cell& cell, float from_m) const {
  std::optional<float> found;
  float nearest_m = step_m_ + kSlack_m;
  for (const Span& span : columns_.at(cell).spans) {
    const float away_m = std::abs(span.surface_m - from_m);
    if (away_m > nearest_m || span.kink_m > step_m_ + kSlack_m) continue;
    nearest_m = away_m;
    found = span.surface_m;
  }
  return found;
}

void Ground::start(const std::vector<DrivenCell>& driven) {
  for (const DrivenCell& at : driven) {
    if (!box_.contains(at.cell) || footing(at.cell) == Footing::kDriven) continue;
    float height_m = at.height_m;
    float nearest_m = kPoseError_m;
    for (const Span& span : columns_.at(at.cell).spans)
      if (const float away_m = std::abs(span.surface_m - at.height_m); away_m < nearest_m) {
        nearest_m = away_m;
        height_m = span.surface_m;
      }
    put(at.cell, Footing::kDriven, height_m);
    edge_.push_back(at.cell);
  }
}

void Ground::flood() {
  for (std::size_t i = 0; i < edge_.size(); ++i) {
    const Cell from = edge_[i];
    const float from_m = height_m(from);
    for (const Cell& way : kAround) step_to(from + way, from_m);
    for (const Cell& way : kAround) bridge(from, way);
  }
}

void Ground::step_to(const Cell& cell, float from_m) {
  if (!box_.contains(cell) || footing(cell) >= Footing::kSeen) return;
  const auto floor_m = floor_at(cell, from_m);
  if (!floor_m) return;
  put(cell, Footing::kSeen, *floor_m);
  edge_.push_back(cell);
}

// Floods on to a floor beyond columns without one.
void Ground::bridge(const Cell& from, const Cell& way) {
  const float from_m = height_m(from);
  for (std::int32_t gap = 1; gap <= kBridge; ++gap) {
    const Cell last = from + times(way, gap), beyond = last + way;
    if (!box_.contains(beyond) || footing(last) >= Footing::kSeen || !is_gap(last, from_m)) return;
    if (gap > 1 && (is_passed_below(last, from_m) || is_passed_below(from + way, from_m))) return;
    const auto floor_m = footing(beyond) >= Footing::kSeen ? std::optional(height_m(beyond))
                                                           : floor_at(beyond, from_m);
    if (!floor_m || std::abs(*floor_m - from_m) > step_m_ + kSlack_m) continue;
    for (std::int32_t k = 1; k <= gap; ++k) put(from + times(way, k), Footing::kBridged, from_m);
    step_to(beyond, from_m);
    return;
  }
}

// Nothing was hit about the floor, and a ray passed close above it.
bool Ground::is_gap(const Cell& cell, float height_m) const {
  const Column column = columns_.at(cell);
  const double low_m = height_m - 3 * kBelow_m, high_m = height_m + step_m_ + kSlack_m;
  const bool is_hit = std::ranges::any_of(column.spans, [&](const Span& span) {
    return span.bottom * kFinestResolution_m < high_m && span.top * kFinestResolution_m > low_m;
  });
  return !is_hit && std::ranges::any_of(column.free, [&](const FreeRun& run) {
    return run.bottom * kColumn_m < height_m + kCloseAbove_m &&
           run.top * kColumn_m > height_m + kBelow_m;
  });
}

// A ray passed in a cell below the floor. A robot's wheel gets over a single column all the same.
bool Ground::is_passed_below(const Cell& cell, float height_m) const {
  return std::ranges::any_of(columns_.at(cell).free, [&](const FreeRun& run) {
    return (run.bottom + 1) * kColumn_m < height_m + kSlack_m &&
           run.top * kColumn_m > height_m - kReach_m;
  });
}

// The height of the floor beyond its edge.
void Ground::reach_on() {
  std::vector<Cell> level;
  for (std::int32_t y = box_.low.y; y < box_.high.y; ++y)
    for (std::int32_t x = box_.low.x; x < box_.high.x; ++x)
      if (footing({x, y}) >= Footing::kBridged) level.push_back({x, y});
  const auto levels = static_cast<int>(kReach_m / kColumn_m);
  std::vector<int> reached(box_.size(), 0);
  for (int i = 1; i <= levels && !level.empty(); ++i) {
    std::vector<Cell> next;
    for (const Cell& from : level)
      for (const Cell& way : kAround) {
        const Cell cell = from + way;
        if (!box_.contains(cell) || footing(cell) >= Footing::kBridged) continue;
        int& at = reached[box_.index(cell)];
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
