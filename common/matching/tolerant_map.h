#pragma once

#include <cstdint>
#include <cstring>
#include <vector>

#include "voxels/voxel_map.h"

namespace voxlist {

/// A map as a whole-map search counts on it: cells of edge e, in layers twice as high (a planar
/// pose does not move points up or down), that hold an occupied voxel or touch the face of a cell
/// of edge e that does. So the true pose has nearly all of its points in occupied cells.
///
/// Readable as windows: one load tells 8 x 8 cells. That takes a byte a cell: 60 x 40 x 2.6 m at
/// 0.04 m are 60 MB.
class TolerantMap {
 public:
  /// Cells along a window's edge.
  static constexpr std::int32_t kWindow = 8;

  /// `cell_m`: e, a multiple of the map's resolution; doubled until the cells fit into 2^31 bytes.
  TolerantMap(const VoxelMap& map, double cell_m);

  double cell_m() const { return cell_m_; }
  double layer_m() const { return 2.0 * cell_m_; }
  bool empty() const { return size_x_ == 0; }

  /// Lowest cell and number of cells. Cells are counted from the lowest everywhere below.
  const Voxel& lowest() const { return lowest_; }
  std::int32_t size_x() const { return size_x_; }
  std::int32_t size_y() const { return size_y_; }
  std::int32_t size_z() const { return size_z_; }

  /// The layer of a height (m), which may be outside.
  std::int32_t layer(double z_m) const;

  /// Whether the window at a cell lies within the map.
  bool holds(std::int32_t x, std::int32_t y) const {
    return x >= 0 && y >= 0 && x + kWindow <= size_x_ && y + kWindow <= size_y_;
  }

  /// Place of the window at a cell: linear in x, y, z.
  std::int64_t place(std::int32_t x, std::int32_t y, std::int32_t z) const {
    return (std::int64_t{z} * size_y_ + y) * size_x_ + x;
  }

  /// The window at a place: bit 8 i + k is cell (x + i, y + k, z).
  std::uint64_t window(std::int64_t place) const {
    std::uint64_t bits;
    std::memcpy(&bits, columns_.data() + place, sizeof bits);
    return bits;
  }

  /// The window at any cell: what is outside the map is free.
  std::uint64_t window_anywhere(std::int32_t x, std::int32_t y, std::int32_t z) const;

  std::int64_t occupied_cells() const { return occupied_cells_; }

  /// Share of the map's ground plan that is occupied in a layer: near 1 for floors and ceilings,
  /// which match wherever the robot is. 0 outside.
  double fill(std::int32_t z) const {
    return z < 0 || z >= size_z_ ? 0.0 : fill_[static_cast<std::size_t>(z)];
  }

 private:
  void measure(const VoxelMap& map, double cell_m);
  void mark_cells(const VoxelMap& map);
  void measure_fill();
  void make_columns();

  double cell_m_;
  Voxel lowest_{0, 0, 0};
  std::int32_t size_x_ = 0, size_y_ = 0, size_z_ = 0;
  std::vector<std::uint8_t> columns_;  // bit k of a cell's byte is the cell k rows farther
  std::vector<double> fill_;
  std::int64_t occupied_cells_ = 0;
};

}  // namespace voxlist
