#include "voxlist/planning/obstacles/ground.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <queue>
#include <tuple>

#include "voxlist/geometry/angle.h"
#include "voxlist/geometry/elementary.h"

namespace voxlist::planning {
namespace {

constexpr float kNone = std::numeric_limits<float>::infinity();

// Cells are beside each other up to so many cells: the mirror scanner's beams and lines within a
// metre of the robot, and those of a few sweeps farther out.
constexpr double kBeside = 3.0;

// Slopes beside a strip are measured over so much (m): less, and noise is steeper than a ramp. They
// are the same within kEven (2.3 deg): what the robot rocks by makes of it.
constexpr float kSlopeFrom_m = 0.6F, kSlopeTo_m = 2.0F, kEven = 0.04F;

// Points so far above the lowest of their cell (m) stand on it: more than a slope and rocking make
// within a cell, and lower than what hangs.
constexpr float kUprightFrom_m = 0.06F, kUprightTo_m = 0.3F;

// Places of the floor that a new one is held against.
constexpr int kHeldAgainst = 16;

double tangent(double angle_deg) {
  const auto [sine, cosine] = elementary::sine_cosine(angle_deg * kRadPerDeg);
  return sine / cosine;
}

// Lower and higher points than the wheels' plane and every slope explain cannot be floor.
bool is_plausible(float low_m, float range_m, const FloorRule& rule, float wheels_m) {
  return std::abs(low_m - wheels_m) <= rule.most_m(range_m, range_m);
}

// Grows the floor over the cells.
class Growth {
 public:
  Growth(const LocalGrid& grid, std::vector<float> low_m, const ObstacleConfig& config)
      : grid_(grid),
        beside_(grid.disc(kBeside * config.cell_m)),
        across_(grid.disc(config.gap_m)),
        rule_(config),
        wheels_m_(static_cast<float>(config.floor_z_m)),
        low_m_(std::move(low_m)),
        cost_m_(grid.size(), kNone),
        is_floor_(grid.size(), 0),
        asked_(grid.size(), grid.size()) {
    for (std::size_t cell = 0; cell < low_m_.size(); ++cell)
      if (is_plausible(low_m_[cell], grid.range_m(cell), rule_, wheels_m_))
        candidates_.push_back(cell);
  }

  // Cells that the wheels' own plane leads to.
  void start(const ObstacleConfig& config) {
    const auto own_m = static_cast<float>(config.min_range_m);
    for (const std::size_t cell : candidates_)
      if (grid_.range_m(cell) <= static_cast<float>(config.unseen_near_m))
        offer(cell, wheels_m_, std::max(0.0F, grid_.range_m(cell) - own_m));
  }

  void run() {
    do {
      join_offered();
      cross_strips();
    } while (!offers_.empty());
  }

  std::vector<std::uint8_t> floor() && { return std::move(is_floor_); }
  const std::vector<float>& low_m() const { return low_m_; }

 private:
  using Offer = std::tuple<float, std::size_t>;  // cost and cell: the order is the same everywhere

  void join_offered() {
    while (!offers_.empty()) {
      const std::size_t cell = std::get<1>(offers_.top());
      offers_.pop();
      if (is_floor_[cell] || !fits(cell)) continue;
      is_floor_[cell] = 1;
      grid_.around(cell, beside_, [&](std::size_t other, float away_m) {
        if (!is_floor_[other] && low_m_[other] != kNone) offer(other, low_m_[cell], away_m);
      });
    }
  }

  void cross_strips() {
    std::erase_if(candidates_, [&](std::size_t cell) { return is_floor_[cell] != 0; });
    for (const std::size_t cell : candidates_)
      grid_.while_around(cell, across_, [&](std::size_t other, float away_m) {
        if (!is_floor_[other]) return true;
        // The same floor says the same again.
        if (asked_[cell] != other && goes_on(other, cell, away_m))
          offer(cell, low_m_[other], away_m);
        asked_[cell] = other;
        return false;
      });
  }

  // Whether what is beyond a strip may be the same floor: as high, or on a ramp. The strip of a
  // ramp is as steep as what is before it, what is behind it, or between; that of a kerb is steeper
  // than both.
  bool goes_on(std::size_t before, std::size_t behind, float away_m) const {
    const float up_m = low_m_[behind] - low_m_[before];
    if (std::abs(up_m) <= rule_.most_m(0.0F, grid_.range_m(behind))) return true;
    const Eigen::Vector2f way = (grid_.centre(behind) - grid_.centre(before)) / away_m;
    const auto slope_behind = slope_along(behind, way);
    if (!slope_behind) return false;
    const float slope_before = -slope_along(before, -way).value_or(0.0F);
    const float slope = up_m / away_m;
    return slope > std::min(slope_before, *slope_behind) - kEven &&
           slope < std::max(slope_before, *slope_behind) + kEven;
  }

  // How much the lowest points rise from a cell on along a way; nothing where no others are near.
  std::optional<float> slope_along(std::size_t cell, const Eigen::Vector2f& way) const {
    for (float on_m = kSlopeFrom_m; on_m <= kSlopeTo_m; on_m += grid_.cell_m()) {
      const auto other = grid_.at(grid_.centre(cell) + on_m * way);
      if (other && is_plausible(low_m_[*other], grid_.range_m(*other), rule_, wheels_m_))
        return (low_m_[*other] - low_m_[cell]) / on_m;
    }
    return std::nullopt;
  }

  bool joins(std::size_t cell, float floor_m, float away_m) const {
    return std::abs(low_m_[cell] - floor_m) <= rule_.most_m(away_m, grid_.range_m(cell));
  }

  void offer(std::size_t cell, float floor_m, float away_m) {
    const float cost_m = std::abs(low_m_[cell] - floor_m);
    if (cost_m >= cost_m_[cell] || !joins(cell, floor_m, away_m)) return;
    cost_m_[cell] = cost_m;
    offers_.push({cost_m, cell});
  }

  // Held against the nearest of the floor: what is farther allows more.
  bool fits(std::size_t cell) const {
    bool fits = true;
    int held = 0;
    grid_.while_around(cell, across_, [&](std::size_t other, float away_m) {
      if (!is_floor_[other]) return true;
      fits = joins(cell, low_m_[other], away_m);
      return fits && ++held < kHeldAgainst;
    });
    return fits;
  }

  const LocalGrid& grid_;
  const std::vector<LocalGrid::Neighbour> beside_, across_;
  const FloorRule rule_;
  const float wheels_m_;
  const std::vector<float> low_m_;
  std::vector<float> cost_m_;
  std::vector<std::uint8_t> is_floor_;
  std::vector<std::size_t> asked_;  // the floor before a strip that was asked last; size(): none
  std::vector<std::size_t> candidates_;  // not floor yet
  std::priority_queue<Offer, std::vector<Offer>, std::greater<>> offers_;
};

// Takes out the cells of walls and posts, whose points go up from the lowest one: along a wall
// their lowest points lead from any floor to any other. What hangs higher up leaves the floor.
void take_out_upright(const LocalGrid& grid, const std::vector<Ray>& rays,
                      std::vector<float>& low_m) {
  std::vector<std::uint8_t> is_upright(grid.size());
  for (const Ray& ray : rays) {
    const auto cell = grid.at(ray.point.head<2>());
    if (!cell) continue;
    const float up_m = ray.point.z() - low_m[*cell];
    if (up_m > kUprightFrom_m && up_m < kUprightTo_m) is_upright[*cell] = 1;
  }
  for (std::size_t cell = 0; cell < low_m.size(); ++cell)
    if (is_upright[cell]) low_m[cell] = kNone;
}

// Gives each cell the height of the nearest floor: from cell to cell, nearest first.
void spread(const LocalGrid& grid, const std::vector<float>& low_m, float wheels_m,
            LocalFloor& ground) {
  const auto beside = grid.disc(1.5 * static_cast<double>(grid.cell_m()));
  std::vector<std::size_t> wave;
  ground.height_m.assign(grid.size(), wheels_m);
  ground.away_m.assign(grid.size(), kNone);
  for (std::size_t cell = 0; cell < grid.size(); ++cell)
    if (ground.is_floor[cell] || grid.centre(cell).norm() < grid.cell_m()) {
      ground.height_m[cell] = ground.is_floor[cell] ? low_m[cell] : wheels_m;
      ground.away_m[cell] = 0.0F;
      wave.push_back(cell);
    }
  for (std::size_t i = 0; i < wave.size(); ++i)
    grid.around(wave[i], beside, [&](std::size_t other, float step_m) {
      const float away_m = ground.away_m[wave[i]] + step_m;
      if (away_m >= ground.away_m[other]) return;
      if (ground.away_m[other] == kNone) wave.push_back(other);
      ground.away_m[other] = away_m;
      ground.height_m[other] = ground.height_m[wave[i]];
    });
}

}  // namespace

FloorRule::FloorRule(const ObstacleConfig& config)
    : step_m_(static_cast<float>(config.step_m)),
      slope_(static_cast<float>(tangent(config.max_slope_deg))),
      rocking_(2.0F * static_cast<float>(tangent(config.rocking_deg))) {}

bool is_below_floor(const Ray& ray, const ObstacleConfig& config) {
  const float up_m = ray.point.z() - static_cast<float>(config.floor_z_m);
  return ray.drop.below_m > 0.0F && std::abs(up_m + ray.drop.below_m) < std::abs(up_m);
}

std::vector<float> lowest_points(const LocalGrid& grid, const std::vector<Ray>& rays,
                                 const ObstacleConfig& config) {
  std::vector<float> low_m(grid.size(), kNone);
  for (const Ray& ray : rays)
    if (const auto cell = grid.at(ray.point.head<2>()); cell && !is_below_floor(ray, config))
      low_m[*cell] = std::min(low_m[*cell], ray.point.z());
  return low_m;
}

LocalFloor find_ground(const LocalGrid& grid, const std::vector<Ray>& rays,
                       const std::vector<float>& remembered, const ObstacleConfig& config) {
  std::vector<float> low_m = lowest_points(grid, rays, config);
  take_out_upright(grid, rays, low_m);
  for (std::size_t cell = 0; cell < remembered.size(); ++cell)
    if (low_m[cell] == kNone && std::isfinite(remembered[cell])) low_m[cell] = remembered[cell];
  Growth growth(grid, std::move(low_m), config);
  growth.start(config);
  growth.run();
  LocalFloor ground;
  const std::vector<float> heights = growth.low_m();
  ground.is_floor = std::move(growth).floor();
  spread(grid, heights, static_cast<float>(config.floor_z_m), ground);
  return ground;
}

}  // namespace voxlist::planning
