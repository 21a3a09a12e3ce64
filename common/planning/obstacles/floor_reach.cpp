#include "voxlist/planning/obstacles/floor_reach.h"

#include <algorithm>

#include "voxlist/geometry/angle.h"
#include "voxlist/geometry/elementary.h"
#include "voxlist/planning/rays/beam_spacing.h"

namespace voxlist::planning {
namespace {

// A strip between two beams is no wider than so many of their spacings: the robot pitches, and the
// mirror does not turn quite evenly. At two a beam is missing.
constexpr double kSpacings = 1.5;

// Floor is confirmed in cells: strips narrower than so many of them cannot be told.
constexpr double kCells = 2.5;

// One bearing's way out.
class Walk {
 public:
  Walk(const LocalGrid& grid, const LocalFloor& ground, double bearing_rad)
      : grid_(grid), ground_(ground) {
    const auto [sine, cosine] = elementary::sine_cosine(bearing_rad);
    out_ = Eigen::Vector2d(cosine, sine).cast<float>();
  }

  Eigen::Vector2f at(double away_m) const { return static_cast<float>(away_m) * out_; }

  // Floor in the cell there, or beside it: beams of one line are a cell apart and more.
  bool has_floor(double away_m) const { return has(away_m, ground_.is_floor); }

  // An edge goes on beside what was seen of it.
  bool has_drop(double away_m, const std::vector<std::uint8_t>& drops) const {
    return has(away_m, drops);
  }

 private:
  bool has(double away_m, const std::vector<std::uint8_t>& cells) const {
    const Eigen::Vector2f beside = grid_.cell_m() * Eigen::Vector2f(-out_.y(), out_.x());
    return has(at(away_m), cells) || has(at(away_m) + beside, cells) ||
           has(at(away_m) - beside, cells);
  }

  bool has(const Eigen::Vector2f& place, const std::vector<std::uint8_t>& cells) const {
    const auto cell = grid_.at(place);
    return cell && cells[*cell];
  }

  const LocalGrid& grid_;
  const LocalFloor& ground_;
  Eigen::Vector2f out_;
};

// How far out the next floor may be.
double next_floor_m(double from_m, const BeamGeometry& beams, const ObstacleConfig& config) {
  const double next_m = next_on_floor_m(from_m, beams.height_m, kSpacings * beams.spacing_rad);
  const double strip_m = std::max(kCells * config.cell_m, next_m - from_m);
  return std::max(config.unseen_near_m, from_m + std::min(config.gap_m, strip_m));
}

}  // namespace

std::vector<float> floor_reach(const LocalGrid& grid, const LocalFloor& ground,
                               const std::vector<std::uint8_t>& blocked,
                               const std::vector<std::uint8_t>& drops, const BeamGeometry& beams,
                               const ObstacleConfig& config) {
  std::vector<float> reach_m(static_cast<std::size_t>(config.sectors), 0.0F);
  const double step_m = config.cell_m / 2.0;
  for (int sector = 0; sector < config.sectors; ++sector) {
    const Walk walk(grid, ground, kTurn_rad * sector / config.sectors);
    double seen_m = 0.0, next_m = config.unseen_near_m;
    for (double away_m = step_m; away_m <= config.max_range_m; away_m += step_m) {
      const auto cell = grid.at(walk.at(away_m));
      if (!cell || blocked[*cell] || away_m > next_m || walk.has_drop(away_m, drops)) break;
      if (!walk.has_floor(away_m)) continue;
      seen_m = away_m;
      next_m = next_floor_m(seen_m, beams, config);
    }
    reach_m[static_cast<std::size_t>(sector)] = static_cast<float>(seen_m);
  }
  return reach_m;
}

}  // namespace voxlist::planning
