#include "matching/window_search.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "matching/bit_counters.h"
#include "matching/fast_cell.h"

namespace voxlist {
namespace {

constexpr std::int32_t kTile = WindowMap::kTile;
constexpr std::size_t kPlanes = 13;
using Counters = BitCounters<std::uint64_t, kPlanes>;

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
  std::size_t tiles() const {
    return static_cast<std::size_t>(tiles_x) * static_cast<std::size_t>(tiles_y);
  }
};

// The largest of the 64 counts.
int largest(const Counters& counters) {
  std::uint64_t among = ~std::uint64_t{0};
  int value = 0;
  for (std::size_t p = kPlanes; p-- > 0;) {
    if ((among & counters.planes[p]) == 0) continue;
    among &= counters.planes[p];
    value |= 1 << p;
  }
  return value;
}

int count_of(const Counters& counters, int bit) {
  int value = 0;
  for (std::size_t p = 0; p < kPlanes; ++p)
    value |= static_cast<int>(counters.planes[p] >> bit & 1) << p;
  return value;
}

// The points turned to one of the lattice's angles, as places in the map.
class TurnedScan {
 public:
  TurnedScan(const WindowMap& map, const Lattice& lattice, const MatchPoints& scan,
             std::int32_t angle)
      : map_(map), lattice_(lattice) {
    const double yaw = lattice.yaw0_rad + angle * lattice.yaw_step_rad;
    const double c = std::cos(yaw), s = std::sin(yaw);
    places_.reserve(scan.points.size() + kTile);
    for (const auto& p : scan.points) {
      const Voxel cell =
          cell_at(Eigen::Vector3d(c * p.x() - s * p.y(), s * p.x() + c * p.y(), p.z() / 2.0),
                  1.0 / lattice.cell_m);
      if (cell.z < map.lowest_layer() || cell.z >= map.lowest_layer() + map.layers()) continue;
      places_.push_back(map.place(cell.x + lattice.x0, cell.y + lattice.y0, cell.z));
    }
  }

  Counters count(std::int32_t tile_x, std::int32_t tile_y) const {
    const std::int64_t shift = map_.place(tile_x * kTile, tile_y * kTile, 0) - map_.place(0, 0, 0);
    Counters counters;
    std::size_t i = 0;
    std::uint64_t words[8];
    for (; i + 8 <= places_.size(); i += 8) {
      for (std::size_t k = 0; k < 8; ++k) words[k] = map_.tile(places_[i + k] + shift);
      counters.add8(words);
    }
    for (std::size_t k = 0; k < 8; ++k)
      words[k] = i + k < places_.size() ? map_.tile(places_[i + k] + shift) : 0;
    counters.add8(words);
    return counters;
  }

 private:
  const WindowMap& map_;
  const Lattice& lattice_;
  std::vector<std::int64_t> places_;
};

struct CountedPose {
  int count;
  std::int32_t angle, x, y;

  // The best first; ties by position.
  auto rank() const { return std::tuple(-count, angle, y, x); }
};

// All poses of the tiles that hold one of at least `least`, best first.
std::vector<CountedPose> poses_above(const WindowMap& map, const Lattice& lattice,
                                     const MatchPoints& scan, std::span<const int> best_of_tiles,
                                     int least) {
  std::vector<CountedPose> poses;
  for (std::int32_t angle = 0; angle < lattice.angles; ++angle) {
    const auto tiles =
        best_of_tiles.subspan(static_cast<std::size_t>(angle) * lattice.tiles(), lattice.tiles());
    if (*std::max_element(tiles.begin(), tiles.end()) < least) continue;
    const TurnedScan turned(map, lattice, scan, angle);
    for (std::size_t t = 0; t < tiles.size(); ++t) {
      if (tiles[t] < least) continue;
      const auto tx = static_cast<std::int32_t>(t) % lattice.tiles_x,
                 ty = static_cast<std::int32_t>(t) / lattice.tiles_x;
      const Counters counters = turned.count(tx, ty);
      for (int bit = 0; bit < 64; ++bit) {
        const int count = count_of(counters, bit);
        if (count >= least)
          poses.push_back({count, angle, tx * kTile + bit / kTile, ty * kTile + bit % kTile});
      }
    }
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
                           const PoseWindow& window, const SearchConfig& config) {
  SearchResult result;
  if (points.points.empty() || map.layers() == 0) return result;
  const Lattice lattice(cell_m, points.radius_m, window);
  std::vector<int> best_of_tiles(static_cast<std::size_t>(lattice.angles) * lattice.tiles());
  tbb::parallel_for(std::int32_t{0}, lattice.angles, [&](std::int32_t angle) {
    const TurnedScan turned(map, lattice, points, angle);
    int* best = best_of_tiles.data() + static_cast<std::size_t>(angle) * lattice.tiles();
    for (std::int32_t ty = 0; ty < lattice.tiles_y; ++ty) {
      for (std::int32_t tx = 0; tx < lattice.tiles_x; ++tx) *best++ = largest(turned.count(tx, ty));
    }
  });
  const int best = *std::max_element(best_of_tiles.begin(), best_of_tiles.end());
  result.poses_examined = static_cast<std::int64_t>(best_of_tiles.size()) * kTile * kTile;
  result.lattice_poses = static_cast<double>(result.poses_examined);
  result.bound = best;
  if (best == 0) return result;
  const int least = std::max(1, static_cast<int>(std::ceil(config.mode_ratio * best)));
  for (const CountedPose& p : poses_above(map, lattice, points, best_of_tiles, least)) {
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

}  // namespace voxlist
