#pragma once

#include <cstdint>
#include <cstring>
#include <vector>

#include "voxlist/system/check.h"
#include "voxlist/voxels/voxel_map.h"

namespace voxlist::matching {

/// A map dilated by one cell, as a whole-map search counts on it: cells of edge e, in layers twice
/// as high (a planar pose does not move points up or down), that hold an occupied voxel or touch
/// the face of a cell of edge e that does. So the true pose has nearly all of its points in
/// occupied cells.
///
/// Readable as windows of 8 x 8 cells, sharp and blurred: in the map of blur b a cell is occupied
/// when one of the 2^b x 2^b cells from it on is. That takes a bit a cell and blur: 60 x 40 x 2.6 m
/// at 0.04 m are 30 MB, and margins.
class DilatedMap {
 public:
  /// Cells along a window's edge.
  static constexpr std::int32_t kWindow = 8;

  /// Blurs are 0, 1, 2, 3.
  static constexpr std::int32_t kBlurs = 4;

  /// `cell_m`: e, a multiple of the map's resolution; doubled until the cells fit into 2^30 bytes.
  /// `reach_m`: how far from the map's box cells may be asked for.
  DilatedMap(const VoxelMap& map, double cell_m, double reach_m);

  double cell_m() const { return cell_m_; }
  double layer_m() const { return 2.0 * cell_m_; }
  double reach_m() const { return reach_m_; }
  bool empty() const { return size_x_ == 0; }

  /// Lowest cell and number of cells of the map's box. Cells are counted from the lowest everywhere
  /// below.
  const Voxel& lowest() const { return lowest_; }
  std::int32_t size_x() const { return size_x_; }
  std::int32_t size_y() const { return size_y_; }
  std::int32_t size_z() const { return size_z_; }

  /// The layer of a height (m), which may be outside.
  std::int32_t layer(double z_m) const;

  /// Where a window lies.
  struct Place {
    std::int32_t byte, shift;
  };

  /// The place of the window at a cell, which may be outside the box by the reach; its layer must
  /// be inside.
  Place place(std::int32_t x, std::int32_t y, std::int32_t z, std::int32_t blur) const {
    VOXLIST_CHECK(z >= 0 && z < size_z_ && y >= -margin_ && x >= -margin_, "outside the map");
    const std::int32_t row = (y + margin_) / kWindow;
    const std::int64_t rows = (std::int64_t{blur} * size_z_ + z) * rows_ + row;
    return {static_cast<std::int32_t>(rows * row_bytes_ + x + margin_), (y + margin_) % kWindow};
  }

  /// How far places move for a translation by whole windows.
  std::int64_t moved(std::int32_t windows_x, std::int32_t windows_y) const {
    return std::int64_t{windows_y} * row_bytes_ + std::int64_t{windows_x} * kWindow;
  }

  /// The window at a place moved by so much: bit 8 i + k is cell (x + i, y + k, z).
  std::uint64_t window(const Place& place, std::int64_t moved) const {
    const std::uint8_t* from = bytes_.data() + place.byte + moved;
    std::uint64_t low, high;
    std::memcpy(&low, from, sizeof low);
    std::memcpy(&high, from + row_bytes_, sizeof high);
    const std::uint64_t each = 0x0101010101010101;
    const std::uint64_t kept = each * (0xFFU >> place.shift);
    return ((low >> place.shift) & kept) | ((high << (kWindow - place.shift)) & ~kept);
  }

  /// The sharp window at any cell: what is outside the map is free.
  std::uint64_t window_anywhere(std::int32_t x, std::int32_t y, std::int32_t z) const;

  std::int64_t occupied_cells() const { return occupied_cells_; }

  /// Share of the map's ground plan that is occupied in a layer: near 1 for floors and ceilings,
  /// which match wherever the robot is. 0 outside.
  double fill(std::int32_t z) const {
    return z < 0 || z >= size_z_ ? 0.0 : fill_[static_cast<std::size_t>(z)];
  }

 private:
  void measure(const VoxelMap& map, double cell_m);
  double bytes() const;
  void mark_cells(const VoxelMap& map);
  void measure_fill();
  void make_blurred(std::int32_t blur);

  double cell_m_, reach_m_;
  Voxel lowest_{0, 0, 0};
  std::int32_t size_x_ = 0, size_y_ = 0, size_z_ = 0;
  std::int32_t margin_ = 0;  // a multiple of kWindow
  std::int32_t rows_ = 0, row_bytes_ = 0;
  std::vector<std::uint8_t> bytes_;  // by blur, layer, row of 8 cells, x; bit k is the row's cell k
  std::vector<double> fill_;
  std::int64_t occupied_cells_ = 0;
};

}  // namespace voxlist::matching
