#include <algorithm>
#include <cmath>
#include <optional>

#include "voxlist/planning/obstacles/typed_points.h"

namespace voxlist::planning {
namespace {

// Rays that go down through one place and the cells round it. A false echo below the floor, as
// polished stone makes, is alone; a hole of 0.3 m is met by eight beams of one line at 2 m, and by
// four at 4 m.
constexpr int kRays = 3;

// A robot that comes onto a ramp tilts within a sweep, which moves what is far away by this (rad),
// beyond some distance (m). Drops are not told farther away than kFarthest_m.
constexpr float kTilt_rad = 0.05F, kTiltFrom_m = 2.0F, kFarthest_m = 4.0F;

// Floor within this (m) is looked at, not the nearest cell alone: a wall's foot may be taken for
// it.
constexpr double kFloor_m = 0.5;

// Floor this far before a point and behind it (m) tells how high the floor between them is: where a
// ramp of 11 deg begins it is 0.05 m lower at most.
constexpr float kBetween_m = 0.5F;

// Whether a point is deeper below the floor than slope and step explain.
class Depth {
 public:
  Depth(const LocalGrid& grid, const LocalFloor& ground, const ObstacleConfig& config)
      : grid_(grid),
        ground_(ground),
        rule_(config),
        config_(config),
        disc_(grid.disc(kFloor_m)),
        wheels_m_(static_cast<float>(config.floor_z_m)) {}

  // Whether the floor that the ray's line saw beside its end is the floor here; and where that is
  // on one side alone, whether its end is below the wheels' plane, for beside a low box the floor
  // is.
  bool is_drop_in_line(const Ray& ray, std::size_t cell) const {
    const float range_m = grid_.range_m(cell), level_m = ray.point.z() + ray.drop.below_m;
    if (!is_below_floor(ray, config_)) return false;
    if (!ray.drop.is_between && wheels_m_ - ray.point.z() <= rule_.most_m(0.0F, range_m))
      return false;
    return std::abs(ground_.height_m[cell] - level_m) <=
           rule_.most_m(ground_.away_m[cell], range_m);
  }

  // What lies in the wheels' own plane is none. Where floor is seen on both sides, the floor
  // between them is known, and a ramp explains nothing: so a hole is told from less of its far
  // wall.
  bool is_drop(const Eigen::Vector3f& point, std::size_t cell) const {
    const float range_m = grid_.range_m(cell), step_m = rule_.most_m(0.0F, range_m);
    if (wheels_m_ - point.z() <= step_m) return false;
    const auto level_m = between(point.head<2>());
    return (level_m && lower_of(*level_m) - point.z() > step_m + tilt_m(range_m)) ||
           is_below(point.z(), cell);
  }

  // A floor's level, or the wheels': the foot of a wall may be taken for floor that rises, and
  // makes nothing before it deeper.
  float lower_of(float floor_m) const { return std::min(floor_m, wheels_m_); }

 private:
  bool is_below(float z_m, std::size_t cell) const {
    if (!is_below(z_m, ground_.height_m[cell], ground_.away_m[cell], cell)) return false;
    bool below = true;
    grid_.while_around(cell, disc_, [&](std::size_t other, float away_m) {
      if (ground_.is_floor[other]) below = is_below(z_m, ground_.height_m[other], away_m, cell);
      return below;
    });
    return below;
  }

  // Height of the floor at a place, by the nearest floor before it and behind it; nothing where one
  // of them is not seen.
  std::optional<float> between(const Eigen::Vector2f& place) const {
    const Eigen::Vector2f out = place.normalized();
    const auto before = along(place, -out), behind = along(place, out);
    if (!before || !behind) return std::nullopt;
    const float share = before->away_m / (before->away_m + behind->away_m);
    return before->height_m + share * (behind->height_m - before->height_m);
  }

  struct Found {
    float away_m, height_m;
  };

  std::optional<Found> along(const Eigen::Vector2f& place, const Eigen::Vector2f& way) const {
    for (float on_m = grid_.cell_m(); on_m <= kBetween_m; on_m += grid_.cell_m() / 2.0F) {
      const auto cell = grid_.at(place + on_m * way);
      if (cell && ground_.is_floor[*cell]) return Found{on_m, ground_.height_m[*cell]};
    }
    return std::nullopt;
  }

  static float tilt_m(float range_m) { return kTilt_rad * std::max(0.0F, range_m - kTiltFrom_m); }

  bool is_below(float z_m, float floor_m, float away_m, std::size_t cell) const {
    const float range_m = grid_.range_m(cell);
    return lower_of(floor_m) - z_m > rule_.most_m(away_m, range_m) + tilt_m(range_m);
  }

  const LocalGrid& grid_;
  const LocalFloor& ground_;
  const FloorRule rule_;
  const ObstacleConfig& config_;
  const std::vector<LocalGrid::Neighbour> disc_;
  const float wheels_m_;
};

// Where a ray went through a level.
Eigen::Vector3f crossing(const Ray& ray, float level_m) {
  const float share = (ray.origin.z() - level_m) / (ray.origin.z() - ray.point.z());
  return ray.origin + share * (ray.point - ray.origin);
}

// The last floor on the way out to a place, if it is no farther from it than a strip may be unseen.
Eigen::Vector2f edge_before(const Eigen::Vector2f& place, const LocalGrid& grid,
                            const LocalFloor& ground, const ObstacleConfig& config) {
  const Eigen::Vector2f back = -place.normalized();
  const float reach_m = std::min(static_cast<float>(config.gap_m), place.norm());
  for (float back_m = 0.0F; back_m < reach_m; back_m += grid.cell_m() / 2.0F) {
    const auto cell = grid.at(place + back_m * back);
    if (cell && ground.is_floor[*cell])
      return place + std::max(0.0F, back_m - grid.cell_m() / 2.0F) * back;
  }
  return place;
}

}  // namespace

std::vector<TypedPoint> find_drops(const LocalGrid& grid, const std::vector<Ray>& rays,
                                   const LocalFloor& ground, const ObstacleConfig& config,
                                   std::int64_t until_us) {
  const Depth depth(grid, ground, config);
  std::vector<int> through(grid.size());
  std::vector<TypedPoint> drops;
  for (const Ray& ray : rays) {
    const auto cell = grid.at(ray.point.head<2>());
    if (!cell) continue;
    const bool in_line = depth.is_drop_in_line(ray, *cell);
    if (!in_line && (ray.utime_us > until_us || !depth.is_drop(ray.point, *cell))) continue;
    const float level_m =
        in_line ? ray.point.z() + ray.drop.below_m : depth.lower_of(ground.height_m[*cell]);
    if (ray.origin.z() <= level_m) continue;
    const Eigen::Vector3f place = crossing(ray, level_m);
    const auto from = grid.at(place.head<2>());
    if (!from || grid.range_m(*from) > kFarthest_m) continue;
    ++through[*from];
    drops.push_back({place, ObstacleType::kNegative, *from, ray.utime_us});
  }
  const auto beside = grid.disc(1.5 * static_cast<double>(grid.cell_m()));
  std::erase_if(drops, [&](const TypedPoint& drop) {
    int rays_there = through[drop.cell];
    grid.around(drop.cell, beside, [&](std::size_t other, float) { rays_there += through[other]; });
    const auto away_m = static_cast<double>(drop.place().norm());
    return rays_there < kRays || away_m < config.min_range_m || away_m > config.max_range_m;
  });
  for (TypedPoint& drop : drops) {
    drop.point.head<2>() = edge_before(drop.place(), grid, ground, config);
    drop.cell = grid.at(drop.place()).value_or(drop.cell);
  }
  return drops;
}

}  // namespace voxlist::planning
