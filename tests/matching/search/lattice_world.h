#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "voxlist/geometry/pose.h"
#include "voxlist/matching/counting/turned_points.h"
#include "voxlist/matching/search/global_search.h"

namespace voxlist::matching {

/// A small map of random walls, and points of a scan: some of the walls seen from a random place,
/// which may be at the map's edge, some off every wall, some above and below the map.
struct LatticeWorld {
  VoxelMap map;
  std::vector<Eigen::Vector3f> scan;
};

inline LatticeWorld lattice_world(unsigned seed) {
  std::mt19937 random(seed);
  const auto between = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() % 10'000) / 10'000.0;
  };
  LatticeWorld world;
  const Pose2 T_base_map = Pose2{between(-1, 1), between(-1, 1), between(-3.1, 3.1)}.inverse();
  for (int wall = 0; wall < 8; ++wall) {
    const Pose2 T{between(-1, 1), between(-1, 1), between(-3.1, 3.1)};
    for (double s = 0.0; s < 0.6; s += 0.01)
      for (double z = 0.0; z < 0.4; z += 0.02) {
        const Eigen::Vector3d p = T * Eigen::Vector3d(s, 0.0, z);
        world.map.insert(voxel_at(p, kFinestResolution_m));
        if (random() % 150 == 0) world.scan.push_back((T_base_map * p).cast<float>());
      }
  }
  for (int i = 0; i < 20; ++i)
    world.scan.emplace_back(
        Eigen::Vector3d(between(-1, 1), between(-1, 1), between(-1, 2)).cast<float>());
  return world;
}

/// The overlap of every pose of the lattice, counted pose by pose.
class AllOverlaps {
 public:
  AllOverlaps(const GlobalMap& map, const std::vector<Eigen::Vector3f>& scan)
      : map_(map),
        angles_(TurnedPoints(map.dilated(), scan).angles()),
        size_x_(8 * map.coarse().size_x()),
        size_y_(8 * map.coarse().size_y()) {
    copy_cells();
    overlaps_.resize(index(angles_, 0, 0));
    for (std::int32_t angle = 0; angle < angles_; ++angle)
      for (const auto& p : scan) count(angle, p);
  }

  std::int32_t angles() const { return angles_; }
  std::int32_t size_x() const { return size_x_; }
  std::int32_t size_y() const { return size_y_; }

  int at(std::int32_t angle, std::int32_t x, std::int32_t y) const {
    return overlaps_[index(angle, x, y)];
  }

  Pose2 pose(std::int32_t angle, std::int32_t x, std::int32_t y) const {
    const DilatedMap& cells = map_.dilated();
    return {(cells.lowest().x + x) * cells.cell_m(), (cells.lowest().y + y) * cells.cell_m(),
            wrap_angle(yaw_rad(angle))};
  }

  /// The overlap of a pose of the lattice, or -1.
  int at(const Pose2& pose) const {
    const DilatedMap& cells = map_.dilated();
    const auto nearest = [](double value) { return static_cast<std::int32_t>(std::lround(value)); };
    const std::int32_t angle = (nearest(pose.yaw_rad / yaw_rad(1)) + angles_) % angles_;
    const std::int32_t x = nearest(pose.x_m / cells.cell_m()) - cells.lowest().x,
                       y = nearest(pose.y_m / cells.cell_m()) - cells.lowest().y;
    if (x < 0 || y < 0 || x >= size_x_ || y >= size_y_) return -1;
    return at(angle, x, y);
  }

  /// Calls visit(angle, x, y, overlap) for every pose.
  template <class Visit>
  void for_each(Visit&& visit) const {
    for (std::int32_t angle = 0; angle < angles_; ++angle)
      for (std::int32_t x = 0; x < size_x_; ++x)
        for (std::int32_t y = 0; y < size_y_; ++y) visit(angle, x, y, at(angle, x, y));
  }

  int best() const {
    return overlaps_.empty() ? 0 : *std::max_element(overlaps_.begin(), overlaps_.end());
  }

 private:
  std::size_t index(std::int32_t angle, std::int32_t x, std::int32_t y) const {
    return static_cast<std::size_t>((angle * size_x_ + x) * size_y_ + y);
  }

  double yaw_rad(std::int32_t angle) const { return 2.0 * std::numbers::pi * angle / angles_; }

  void count(std::int32_t angle, const Eigen::Vector3f& p) {
    const DilatedMap& cells = map_.dilated();
    const std::int32_t layer = cells.layer(double(p.z()));
    if (layer < 0 || layer >= cells.size_z()) return;
    // In floats like the search: a point on the border of two cells belongs to the same one.
    const auto c = static_cast<float>(std::cos(yaw_rad(angle)) / cells.cell_m()),
               s = static_cast<float>(std::sin(yaw_rad(angle)) / cells.cell_m());
    const auto dx = static_cast<std::int32_t>(std::floor(c * p.x() - s * p.y())),
               dy = static_cast<std::int32_t>(std::floor(s * p.x() + c * p.y()));
    const std::int32_t y0 = std::max(0, -dy), y1 = std::min(size_y_, cells.size_y() - dy);
    for (std::int32_t x = std::max(0, -dx); x < std::min(size_x_, cells.size_x() - dx); ++x) {
      const std::uint8_t* from = occupied_.data() + place(x + dx, dy, layer);
      std::uint16_t* to = overlaps_.data() + index(angle, x, 0);
      for (std::int32_t y = y0; y < y1; ++y) to[y] = static_cast<std::uint16_t>(to[y] + from[y]);
    }
  }

  std::ptrdiff_t place(std::int32_t x, std::int32_t y, std::int32_t z) const {
    const DilatedMap& cells = map_.dilated();
    return (std::ptrdiff_t{z} * cells.size_x() + x) * cells.size_y() + y;
  }

  // A byte a cell.
  void copy_cells() {
    const DilatedMap& cells = map_.dilated();
    for (std::int32_t z = 0; z < cells.size_z(); ++z)
      for (std::int32_t x = 0; x < cells.size_x(); ++x)
        for (std::int32_t y = 0; y < cells.size_y(); ++y)
          occupied_.push_back(cells.window_anywhere(x, y, z) & 1);
  }

  const GlobalMap& map_;
  std::int32_t angles_, size_x_, size_y_;
  std::vector<std::uint8_t> occupied_;
  std::vector<std::uint16_t> overlaps_;
};

}  // namespace voxlist::matching
