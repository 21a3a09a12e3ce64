#include <algorithm>
#include <limits>

#include "voxlist/planning/obstacles/typed_points.h"

namespace voxlist::planning {
namespace {

// What hangs begins this far above the floor (m). Legs and walls are hit below it by one of the
// mirror scanner's lines within 2 m, which are 0.17 m apart there.
constexpr float kHangs_m = 0.3F;

// Floor that is seen so far behind an edge (m) was seen beneath it.
constexpr float kBehind_m = 0.3F;

// A thing's points are so far apart in height, within a cell and those beside it, as no floor is
// (m).
constexpr float kUpright_m = 0.12F;

// Points of each cell within the robot's heights, which are above the ground (m).
struct Band {
  std::vector<int> points;
  std::vector<float> lowest_m, highest_m;
};

bool is_within(const Ray& ray, float height_m, const ObstacleConfig& config) {
  const auto away_m = static_cast<double>(ray.point.head<2>().norm());
  return height_m >= static_cast<float>(config.min_height_m) &&
         height_m <= static_cast<float>(config.max_height_m) && away_m >= config.min_range_m &&
         away_m <= config.max_range_m;
}

// Whether the floor goes on behind a place, as seen from the robot.
bool has_floor_behind(const Eigen::Vector2f& place, const LocalGrid& grid,
                      const LocalFloor& ground) {
  const Eigen::Vector2f out = place.normalized();
  for (float on_m = grid.cell_m(); on_m <= kBehind_m; on_m += grid.cell_m()) {
    const auto cell = grid.at(place + on_m * out);
    if (cell && ground.is_floor[*cell]) return true;
  }
  return false;
}

// A cell's points together with those beside it.
struct Neighbourhood {
  int points;
  float lowest_m, highest_m;
};

Neighbourhood about(std::size_t cell, const LocalGrid& grid, const Band& band,
                    const std::vector<LocalGrid::Neighbour>& beside) {
  Neighbourhood all{band.points[cell], band.lowest_m[cell], band.highest_m[cell]};
  grid.around(cell, beside, [&](std::size_t other, float) {
    all.points += band.points[other];
    all.lowest_m = std::min(all.lowest_m, band.lowest_m[other]);
    all.highest_m = std::max(all.highest_m, band.highest_m[other]);
  });
  return all;
}

}  // namespace

std::vector<TypedPoint> find_standing(const LocalGrid& grid, const std::vector<Ray>& rays,
                                      const LocalFloor& ground, const ObstacleConfig& config) {
  constexpr float kNone = std::numeric_limits<float>::infinity();
  const FloorRule rule(config);
  Band band{std::vector<int>(grid.size()), std::vector<float>(grid.size(), kNone),
            std::vector<float>(grid.size(), -kNone)};
  std::vector<std::pair<const Ray*, std::size_t>> inside;
  for (const Ray& ray : rays) {
    const auto cell = grid.at(ray.point.head<2>());
    if (!cell) continue;
    const float up_m = ray.point.z() - ground.height_m[*cell];
    if (!is_within(ray, up_m, config)) continue;
    ++band.points[*cell];
    band.lowest_m[*cell] = std::min(band.lowest_m[*cell], up_m);
    band.highest_m[*cell] = std::max(band.highest_m[*cell], up_m);
    inside.emplace_back(&ray, *cell);
  }
  const auto beside = grid.disc(1.5 * config.cell_m);
  std::vector<TypedPoint> standing;
  for (const auto& [ray, cell] : inside) {
    const Neighbourhood all = about(cell, grid, band, beside);
    const Eigen::Vector2f place = ray->point.head<2>();
    const bool is_near = static_cast<double>(place.norm()) <= config.lone_within_m;
    if (all.points < config.min_points && (!is_near || ray->is_mixed)) continue;
    // Beyond the widest strip nothing is known of slopes.
    const float floor_m = std::min(ground.away_m[cell], static_cast<float>(config.gap_m));
    const bool may_be_ramp = all.highest_m <= rule.most_m(floor_m, grid.range_m(cell)) &&
                             all.highest_m - all.lowest_m < kUpright_m;
    if (may_be_ramp) continue;
    const bool hangs = all.lowest_m >= kHangs_m && has_floor_behind(place, grid, ground);
    standing.push_back({ray->point, hangs ? ObstacleType::kOverhang : ObstacleType::kObstacle, cell,
                        ray->utime_us, ray->came});
  }
  return standing;
}

}  // namespace voxlist::planning
