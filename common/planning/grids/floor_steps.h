#pragma once

#include <algorithm>
#include <array>
#include <optional>

#include "voxlist/planning/grids/floor_columns.h"

namespace voxlist::planning {

/// The eight columns about one.
inline constexpr std::array<Cell, 8> kAround = {
    {{-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-1, -1}, {1, 1}, {-1, 1}, {1, -1}}};

/// What noise leaves of the height of a column's surface, and half a voxel (m): steps are told
/// apart to so much.
inline constexpr float kHeightSlack_m = 0.01F;

/// A gap between rays of so many columns is bridged where the floor was hit on both sides: 0.16 m.
/// A hole of 0.3 m is wider.
inline constexpr std::int32_t kBridge = 2;

/// How far beyond its edge a floor's height is told (m).
inline constexpr double kReach_m = 2.0;

inline Cell operator+(const Cell& a, const Cell& b) { return {a.x + b.x, a.y + b.y}; }
inline Cell operator-(const Cell& a, const Cell& b) { return {a.x - b.x, a.y - b.y}; }
inline Cell operator*(std::int32_t steps, const Cell& way) {
  return {steps * way.x, steps * way.y};
}

/// How one gets on from a floor: by a step to a column beside it, or over a gap that fell between
/// rays. What leads where depends on the floor's height and on the columns, on nothing else.
class FloorSteps {
 public:
  FloorSteps(const FloorColumns& columns, double step_m)
      : columns_(columns), step_m_(static_cast<float>(step_m)) {}

  /// Floors whose heights differ by no more are one step apart (m).
  float step_m() const { return step_m_ + kHeightSlack_m; }

  /// The surface next to a height that a step leads to; none where there is a kerb in the column.
  std::optional<float> floor_at(const Column& column, float from_m) const;
  std::optional<float> floor_at(const Cell& cell, float from_m) const {
    return floor_at(columns_.at(cell), from_m);
  }

  /// The floor under a robot that drove at a height: the surface next to it, or that very height.
  float driven_floor(const Cell& cell, float driven_m) const;

  /// Nothing was hit about a floor of this height, and a ray passed close above it.
  bool is_gap(const Column& column, float height_m) const;

  /// Whether a floor goes on over `gap` columns beyond `from`, 1 to kBridge.
  bool is_bridged(const Cell& from, float from_m, const Cell& way, std::int32_t gap) const;

  /// The floor at from + steps * way, where it is reached from the floor at `from`; steps from 1
  /// to kBridge + 1.
  std::optional<float> leads(const Cell& from, float from_m, const Cell& way,
                             std::int32_t steps) const;

  /// Whether a floor of one height is a hit beside which a floor of another has no gap.
  bool is_hit_beside(float height_m, float from_m) const {
    return height_m > from_m - hit_below_m() && height_m < from_m + step_m();
  }

  /// Calls visit(cell, floor_m) for each place that the floor at `from` leads to over the column
  /// beside it.
  template <class Visit>
  void visit_beyond(const Cell& from, float from_m, const Cell& way, const Visit& visit) const {
    const Column beside = columns_.at(from + way);
    if (const auto floor_m = floor_at(beside, from_m)) return visit(from + way, *floor_m);
    if (!is_gap(beside, from_m)) return;
    for (std::int32_t steps = 2; steps <= kBridge + 1; ++steps)
      if (const auto floor_m = leads(from, from_m, way, steps)) visit(from + steps * way, *floor_m);
  }

 private:
  // Hits so far below a floor are its own, or what a step down leads to (m).
  float hit_below_m() const { return std::max(0.12F, step_m()); }

  bool is_passed_below(const Cell& cell, float height_m) const;

  const FloorColumns& columns_;
  const float step_m_;
};

}  // namespace voxlist::planning
