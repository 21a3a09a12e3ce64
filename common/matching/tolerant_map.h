#pragma once

#include <cstdint>
#include <cstring>
#include <vector>

#include "voxels/voxel_map.h"

namespace voxlist {

/// Cells of the lattice that a search counts on: cubes in x and y, twice as high in z (a planar
/// pose does not move points up or down).
struct TolerantMapConfig {
  double cell_m = 0.04;
};

/// A map as a search counts on it: the cells that hold an occupied voxel or touch the face of one
/// that does (the true pose then has nearly all of its points in occupied cells), readable as 8 x 8
/// windows.
class TolerantMap {
 public:
  static constexpr int kWindow = 8;

  TolerantMap(const VoxelMap& map, const TolerantMapConfig& config);

  double cell_m() const { return cell_m_; }
  double cell_height_m() const { return 2.0 * cell_m_; }
  bool empty() const { return size_x_ == 0; }

  /// Lowest cell and number of cells.
  const Voxel& lowest() const { return lowest_; }
  std::int32_t size_x() const { return size_x_; }
  std::int32_t size_y() const { return size_y_; }
  std::int32_t size_z() const { return size_z_; }

  /// Whether the windows of a box of cells can be read without asking.
  bool holds(std::int32_t x, std::int32_t y) const {
    return x >= 0 && y >= 0 && x + kWindow <= size_x_ && y + kWindow <= size_y_;
  }

  /// Byte of cell (x, y, z), counted from lowest(): bit k is cell (x, y + k, z). Eight bytes from
  /// there on are the window, bit 8 i + k is cell (x + i, y + k, z).
  std::int64_t offset(std::int32_t x, std::int32_t y, std::int32_t z) const {
    return (std::int64_t{z} * size_y_ + y) * size_x_ + x;
  }
  std::uint64_t window(std::int64_t offset) const {
    std::uint64_t bits;
    std::memcpy(&bits, bytes_.data() + offset, sizeof bits);
    return bits;
  }
  bool occupied(std::int32_t x, std::int32_t y, std::int32_t z) const {
    return x >= 0 && y >= 0 && z >= 0 && x < size_x_ && y < size_y_ && z < size_z_ &&
           (bytes_[static_cast<std::size_t>(offset(x, y, z))] & 1) != 0;
  }

  /// Share of the cells of the map's ground plan that are occupied in layer z: near 1 for floors
  /// and ceilings, which match wherever the robot is.
  double fill(std::int32_t z) const {
    return z < 0 || z >= size_z_ ? 0.0 : fill_[static_cast<std::size_t>(z)];
  }

 private:
  double cell_m_;
  Voxel lowest_{0, 0, 0};
  std::int32_t size_x_ = 0, size_y_ = 0, size_z_ = 0;
  std::vector<std::uint8_t> bytes_;
  std::vector<double> fill_;
};

}  // namespace voxlist
