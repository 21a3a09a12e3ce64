#include "voxlist/matching/search/window_search.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <tuple>

#include "voxlist/matching/counting/window_count.h"
#include "voxlist/system/check.h"

namespace voxlist::matching {
namespace {

constexpr std::int32_t kTile = WindowMap::kTile;

std::int32_t cells_in(double length_m, double cell_m) {
  return static_cast<std::int32_t>(std::ceil(length_m / cell_m));
}

// The poses: translations by cells from (x0, y0), tiles of 8 x 8 of them, and angles.
struct Lattice {
  double cell_m, yaw0_rad, yaw_step_rad;
  std::int32_t x0, y0, tiles_x, tiles_y, angles;

  Lattice(double cell, double radius_m, const PoseWindow& window) : cell_m(cell) {
    const auto tiles = [&](double half_m) {
      return (2 * cells_in(half_m, cell_m) + 1 + kTile - 1) / kTile;
    };
    tiles_x = tiles(window.half_x_m);
    tiles_y = tiles(window.half_y_m);
    x0 = static_cast<std::int32_t>(std::lround(window.center.x_m / cell_m)) - tiles_x * kTile / 2;
    y0 = static_cast<std::int32_t>(std::lround(window.center.y_m / cell_m)) - tiles_y * kTile / 2;
    const double half_rad = std::min(window.half_yaw_rad, std::numbers::pi);
    const double step_rad = cell_m / std::max(radius_m, cell_m);
    angles = 2 * static_cast<std::int32_t>(std::ceil(half_rad / step_rad)) + 1;
    // The whole circle is divided evenly; a part of it is counted from its middle.
    yaw_step_rad = half_rad == std::numbers::pi ? 2.0 * std::numbers::pi / angles : step_rad;
    yaw0_rad = window.center.yaw_rad - yaw_step_rad * (angles / 2);
  }

  Pose2 pose(std::int32_t angle, std::int32_t x, std::int32_t y) const {
    return {(x0 + x) * cell_m, (y0 + y) * cell_m, wrap_angle(yaw0_rad + angle * yaw_step_rad)};
  }
  std::int64_t poses() const { return std::int64_t{angles} * tiles_x * tiles_y * kTile * kTile; }
};

// Calls visit(tile_x, tile_y, counters) for the tiles of one angle, group by group.
template <class Visit>
void visit_tiles(const WindowCount& count, const Lattice& lattice, std::int32_t angle,
                 const Visit& visit) {
  const auto places =
      count.places(lattice.yaw0_rad + angle * lattice.yaw_step_rad, lattice.x0, lattice.y0);
  for (std::int32_t y = 0; y < lattice.tiles_y; y += count.down()) {
    for (std::int32_t x = 0; x < lattice.tiles_x; x += count.across()) {
      const WindowCount::Group group = count.count(places, x, y);
      auto tile = group.begin();
      for (std::int32_t ty = y; ty < y + count.down(); ++ty)
        for (std::int32_t tx = x; tx < x + count.across(); ++tx, ++tile)
          if (tx < lattice.tiles_x && ty < lattice.tiles_y) visit(tx, ty, *tile);
    }
  }
}

struct CountedPose {
  int count;
  std::int32_t angle, x, y;

  // The best first; ties by position.
  auto rank() const { return std::tuple(-count, angle, y, x); }
};

// All poses with at least `least`, best first. `best` has the largest count of each angle.
std::vector<CountedPose> poses_above(const WindowCount& count, const Lattice& lattice,
                                     const std::vector<int>& best, int least) {
  std::vector<CountedPose> poses;
  for (std::int32_t angle = 0; angle < lattice.angles; ++angle) {
    if (best[static_cast<std::size_t>(angle)] < least) continue;
    visit_tiles(count, lattice, angle, [&](auto tx, auto ty, const WindowCounters& counters) {
      for_each_lane(lanes_from(counters, least), [&](int lane) {
        poses.push_back({count_of(counters, lane), angle, tx * kTile + lane / kTile,
                         ty * kTile + lane % kTile});
      });
    });
  }
  std::sort(poses.begin(), poses.end(),
            [](const auto& a, const auto& b) { return a.rank() < b.rank(); });
  return poses;
}

}  // namespace

CellRectangle needed_ground(double cell_m, double radius_m, const PoseWindow& window) {
  const Lattice lattice(cell_m, radius_m, window);
  const std::int32_t reach = cells_in(radius_m, cell_m) + 1;
  return {lattice.x0 - reach, lattice.y0 - reach, lattice.x0 + lattice.tiles_x * kTile + reach,
          lattice.y0 + lattice.tiles_y * kTile + reach};
}

SearchResult search_window(const WindowMap& map, double cell_m, const MatchPoints& points,
                           const PoseWindow& window, const SearchConfig& config,
                           Instructions instructions) {
  SearchResult result;
  if (points.points.empty() || map.layers() == 0) return result;
  VOXLIST_CHECK(points.points.size() < std::size_t{1} << kCountPlanes,
                std::to_string(points.points.size()) + " points overflow the counters");
  VOXLIST_CHECK(map.holds(needed_ground(cell_m, points.radius_m, window)),
                "the map does not hold the ground of the window");
  const Lattice lattice(cell_m, points.radius_m, window);
  const WindowCount count(map, cell_m, points, instructions);
  std::vector<int> best_of_angles(static_cast<std::size_t>(lattice.angles));
  tbb::parallel_for(std::int32_t{0}, lattice.angles, [&](std::int32_t angle) {
    int& best = best_of_angles[static_cast<std::size_t>(angle)];
    visit_tiles(count, lattice, angle, [&](auto, auto, const WindowCounters& counters) {
      best = std::max(best, largest(counters));
    });
  });
  const int best = *std::max_element(best_of_angles.begin(), best_of_angles.end());
  result.poses_examined = lattice.poses();
  result.lattice_poses = static_cast<double>(result.poses_examined);
  result.bound = best;
  if (best == 0) return result;
  const int least = std::max(1, static_cast<int>(std::ceil(config.mode_ratio * best)));
  for (const CountedPose& p : poses_above(count, lattice, best_of_angles, least)) {
    if (result.modes.size() == config.max_modes) break;
    const Pose2 pose = lattice.pose(p.angle, p.x, p.y);
    const bool known =
        std::any_of(result.modes.begin(), result.modes.end(), [&](const OverlapMode& mode) {
          return distance_m(mode.pose, pose) < config.mode_distance_m &&
                 turn_rad(mode.pose, pose) < config.mode_turn_rad;
        });
    if (!known) result.modes.push_back({pose, p.count});
  }
  result.certified = result.complete = true;
  return result;
}

}  // namespace voxlist::matching
