#include <algorithm>
#include <cmath>
#include <optional>

#include "voxlist/geometry/angle.h"
#include "voxlist/geometry/elementary.h"
#include "voxlist/planning/obstacles/typed_points.h"

namespace voxlist::planning {
namespace {

// Steps are not told farther away than this (m), nor from fewer cells of the lower floor side by
// side.
constexpr float kFarthest_m = 4.0F;
constexpr int kCells = 3;

// Slopes before and behind a step are measured over so much (m): over less, noise is steeper than
// a ramp.
constexpr float kSlopeFrom_m = 0.5F, kSlopeTo_m = 1.2F;

// Floor on the way out in one bearing.
struct Seen {
  float away_m, height_m;
  std::size_t cell;
};

std::vector<Seen> floor_on(const LocalGrid& grid, const LocalFloor& ground, double bearing_rad) {
  const auto [sine, cosine] = elementary::sine_cosine(bearing_rad);
  const Eigen::Vector2f out = Eigen::Vector2d(cosine, sine).cast<float>();
  std::vector<Seen> seen;
  for (float away_m = 0.0F; away_m < kFarthest_m + kSlopeTo_m; away_m += grid.cell_m() / 2.0F) {
    const auto cell = grid.at(away_m * out);
    if (!cell || !ground.is_floor[*cell] || (!seen.empty() && seen.back().cell == *cell)) continue;
    seen.push_back({away_m, ground.height_m[*cell], *cell});
  }
  return seen;
}

// How much the floor falls for each metre between one place and one at a distance, which is looked
// for from `from` on, in steps of `step`; nothing where none was seen there.
std::optional<float> fall_beyond(const std::vector<Seen>& seen, std::ptrdiff_t from,
                                 std::ptrdiff_t step) {
  const Seen& start = seen[static_cast<std::size_t>(from)];
  for (std::ptrdiff_t i = from; i >= 0 && i < std::ssize(seen); i += step) {
    const Seen& other = seen[static_cast<std::size_t>(i)];
    const float apart_m = std::abs(other.away_m - start.away_m);
    if (apart_m > kSlopeTo_m) return std::nullopt;
    if (apart_m >= kSlopeFrom_m)
      return (start.height_m - other.height_m) / (other.away_m - start.away_m);
  }
  return std::nullopt;
}

// Whether a place of the floor is a step lower than the one before it.
bool is_step_down(const std::vector<Seen>& seen, std::size_t place, const FloorRule& rule,
                  float wheels_m, float cell_m) {
  const Seen &upper = seen[place - 1], &lower = seen[place];
  const float least_m = rule.most_m(0.0F, lower.away_m);
  if (upper.height_m - lower.height_m < least_m || wheels_m - lower.height_m < least_m)
    return false;
  const auto at = static_cast<std::ptrdiff_t>(place);
  const auto behind = fall_beyond(seen, at, 1);
  if (!behind) return false;
  // Without floor before it there are the wheels.
  const float before = fall_beyond(seen, at - 1, -1)
                           .value_or((wheels_m - upper.height_m) / std::max(upper.away_m, cell_m));
  const float ramp_m = std::max({0.0F, before, *behind}) * (lower.away_m - upper.away_m);
  // What stands on the floor may be among it: the floor is no higher than a ramp before it.
  const float upper_m = std::min(upper.height_m, wheels_m - before * upper.away_m + least_m);
  return upper_m - lower.height_m - ramp_m >= least_m;
}

}  // namespace

std::vector<TypedPoint> find_steps_down(const LocalGrid& grid, const LocalFloor& ground,
                                        const ObstacleConfig& config, std::int64_t utime_us) {
  const FloorRule rule(config);
  const auto wheels_m = static_cast<float>(config.floor_z_m);
  std::vector<int> lower_cells(grid.size());
  std::vector<std::uint8_t> is_counted(grid.size());
  std::vector<TypedPoint> steps;
  for (int sector = 0; sector < config.sectors; ++sector) {
    const double bearing_rad = kTurn_rad * sector / config.sectors;
    const std::vector<Seen> seen = floor_on(grid, ground, bearing_rad);
    for (std::size_t i = 1; i < seen.size(); ++i) {
      if (!is_step_down(seen, i, rule, wheels_m, grid.cell_m())) continue;
      const Seen &upper = seen[i - 1], &lower = seen[i];
      const auto [sine, cosine] = elementary::sine_cosine(bearing_rad);
      const Eigen::Vector2d edge = upper.away_m * Eigen::Vector2d(cosine, sine);
      steps.push_back({{static_cast<float>(edge.x()), static_cast<float>(edge.y()), upper.height_m},
                       ObstacleType::kNegative,
                       upper.cell,
                       utime_us});
      if (!is_counted[lower.cell]) ++lower_cells[upper.cell];
      is_counted[lower.cell] = 1;
      break;
    }
  }
  const auto beside = grid.disc(1.5 * static_cast<double>(grid.cell_m()));
  std::erase_if(steps, [&](const TypedPoint& step) {
    int cells = lower_cells[step.cell];
    grid.around(step.cell, beside, [&](std::size_t other, float) { cells += lower_cells[other]; });
    return cells < kCells || static_cast<double>(step.place().norm()) < config.min_range_m;
  });
  return steps;
}

}  // namespace voxlist::planning
