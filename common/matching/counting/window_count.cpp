#include "voxlist/matching/counting/window_count.h"

#include <cmath>

#include "voxlist/geometry/elementary.h"
#include "voxlist/matching/counting/window_count_kernel.h"
#include "voxlist/voxels/fast_cell.h"

namespace voxlist::matching {

void window_turn_avx2(const TurnJob& job);
void window_turn_avx512(const TurnJob& job);
void window_count_avx2(const CountJob& job);
void window_count_avx512(const CountJob& job);

WindowCount::WindowCount(const WindowMap& map, double cell_m, const MatchPoints& points,
                         Instructions instructions)
    : map_(map), cells_per_m_(1.0 / cell_m), instructions_(instructions) {
  static_assert(kWindowPlanes == kCountPlanes);
  if (instructions != Instructions::kPortable) {
    down_ = 2;
    across_ = instructions == Instructions::kAvx512 ? 4 : 2;
  }
  for (const auto& p : points.points) {
    const std::int32_t z =
        cell_at(Eigen::Vector3d(0.0, 0.0, p.z()), 1.0 / map.layer_m()).z - map.lowest_layer();
    if (z < 0 || z >= map.layers()) continue;
    x_m_.push_back(p.x());
    y_m_.push_back(p.y());
    layers_.push_back(map.place(0, 0, z + map.lowest_layer()));
  }
}

std::vector<std::int64_t> WindowCount::places(double yaw_rad, std::int32_t x,
                                              std::int32_t y) const {
  std::vector<std::int64_t> places(layers_.size());
  const auto [sine, cosine] = elementary::sine_cosine(yaw_rad);
  const TurnJob job{x_m_.data(),    y_m_.data(),      layers_.data(),
                    layers_.size(), cosine,           sine,
                    cells_per_m_,   map_.row_bytes(), map_.place(x, y, 0) - map_.place(0, 0, 0),
                    places.data()};
  switch (instructions_) {
    case Instructions::kPortable:
      turn_points(job);
      break;
    case Instructions::kAvx2:
      window_turn_avx2(job);
      break;
    case Instructions::kAvx512:
      window_turn_avx512(job);
      break;
  }
  return places;
}

WindowCount::Group WindowCount::count(std::span<const std::int64_t> places, std::int32_t tile_x,
                                      std::int32_t tile_y) const {
  Group group;
  static_assert(sizeof(Group) == kMostTiles * kWindowPlanes * sizeof(std::uint64_t));
  const std::int64_t moved = map_.place(tile_x * kTile, tile_y * kTile, 0) - map_.place(0, 0, 0);
  const CountJob job{map_.columns() + moved, places.data(), places.size(), map_.row_bytes(),
                     group.front().planes};
  switch (instructions_) {
    case Instructions::kPortable:
      count_group<std::uint64_t, std::uint64_t>(job);
      break;
    case Instructions::kAvx2:
      window_count_avx2(job);
      break;
    case Instructions::kAvx512:
      window_count_avx512(job);
      break;
  }
  return group;
}

}  // namespace voxlist::matching
