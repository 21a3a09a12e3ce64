#include "voxlist/planning/grids/floor_steps.h"

#include <algorithm>
#include <cmath>

namespace voxlist::planning {
namespace {

// A floor that was not hit: a ray passed so close above it (m), and none in a cell below.
constexpr double kCloseAbove_m = 0.16, kBelow_m = 0.04;

// Under a floor the robot's height is off by less than this where it drove (m).
constexpr float kPoseError_m = 0.05F;

}  // namespace

std::optional<float> FloorSteps::floor_at(const Column& column, float from_m) const {
  std::optional<float> found;
  float nearest_m = step_m();
  for (const Span& span : column.spans) {
    const float away_m = std::abs(span.surface_m - from_m);
    if (away_m > nearest_m || span.kink_m > step_m()) continue;
    nearest_m = away_m;
    found = span.surface_m;
  }
  return found;
}

float FloorSteps::driven_floor(const Cell& cell, float driven_m) const {
  float floor_m = driven_m, nearest_m = kPoseError_m;
  for (const Span& span : columns_.at(cell).spans)
    if (const float away_m = std::abs(span.surface_m - driven_m); away_m < nearest_m) {
      nearest_m = away_m;
      floor_m = span.surface_m;
    }
  return floor_m;
}

bool FloorSteps::is_gap(const Column& column, float height_m) const {
  const double low_m = height_m - hit_below_m(), high_m = height_m + step_m();
  const bool is_hit = std::ranges::any_of(column.spans, [&](const Span& span) {
    return span.bottom * kFinestResolution_m < high_m && span.top * kFinestResolution_m > low_m;
  });
  return !is_hit && std::ranges::any_of(column.free, [&](const FreeRun& run) {
    return run.bottom * kColumn_m < height_m + kCloseAbove_m &&
           run.top * kColumn_m > height_m + kBelow_m;
  });
}

// A ray passed in a cell below the floor. A robot's wheel gets over a single column all the same.
bool FloorSteps::is_passed_below(const Cell& cell, float height_m) const {
  return std::ranges::any_of(columns_.at(cell).free, [&](const FreeRun& run) {
    return (run.bottom + 1) * kColumn_m < height_m + kHeightSlack_m &&
           run.top * kColumn_m > height_m - kReach_m;
  });
}

bool FloorSteps::is_bridged(const Cell& from, float from_m, const Cell& way,
                            std::int32_t gap) const {
  for (std::int32_t k = 1; k <= gap; ++k) {
    const Cell cell = from + k * way;
    if (!is_gap(columns_.at(cell), from_m) || (gap > 1 && is_passed_below(cell, from_m)))
      return false;
  }
  return true;
}

std::optional<float> FloorSteps::leads(const Cell& from, float from_m, const Cell& way,
                                       std::int32_t steps) const {
  if (steps > 1 && !is_bridged(from, from_m, way, steps - 1)) return std::nullopt;
  return floor_at(from + steps * way, from_m);
}

}  // namespace voxlist::planning
