#pragma once

#include <cstdint>
#include <cstring>
#include <vector>

#include "voxels/voxel_map.h"

namespace voxlist {

/// A rectangle of the ground, in cells; ends are one past the last.
struct CellRectangle {
  std::int32_t low_x = 0, low_y = 0, end_x = 0, end_y = 0;

  bool holds(const CellRectangle& other) const {
    return other.low_x >= low_x && other.low_y >= low_y && other.end_x <= end_x &&
           other.end_y <= end_y;
  }
};

/// The part of a map over a rectangle, ready for counting overlaps: columns half a block wide (0.08
/// m) and a block high (0.16 m) that hold an occupied voxel, or touch the side of one that does. So
/// the lattice pose next to the true one has nearly all of its points in occupied cells.
class WindowMap {
 public:
  /// Cells along the edge of what one load tells.
  static constexpr std::int32_t kTile = 8;

  /// Takes in at least `ground`.
  WindowMap(const VoxelMap& map, const CellRectangle& ground);

  /// Takes in what blocks of the map have gained; voxels that went stay. False: a block is higher
  /// or lower than all that are held; then only another WindowMap helps.
  bool add(const VoxelMap& map, const std::vector<Voxel>& blocks);

  static double cell_m(const VoxelMap& map) { return map.resolution_m() * kBlockEdge / 2; }
  static double layer_m(const VoxelMap& map) { return map.resolution_m() * kBlockEdge; }

  /// Where cells can be read: tiles must lie within.
  const CellRectangle& ground() const { return ground_; }
  std::int32_t lowest_layer() const { return lowest_z_; }
  std::int32_t layers() const { return size_z_; }

  /// Place of a cell: linear in x, y, and z (the layer, which must be one of the map's).
  std::int64_t place(std::int32_t x, std::int32_t y, std::int32_t z) const {
    return (std::int64_t{z - lowest_z_} * size_y_ + (y - low_y_)) * size_x_ + (x - low_x_);
  }

  /// The tile at a place: bit 8 i + k is cell (x + i, y + k, z).
  std::uint64_t tile(std::int64_t place) const {
    std::uint64_t bits;
    std::memcpy(&bits, columns_.data() + place, sizeof bits);
    return bits;
  }

  /// Cells over a rectangle, rounded to 32 of them, from the lowest occupied layer to the highest,
  /// and the occupied ones among them. Depends on the map and the rectangle alone, which must lie
  /// within ground().
  struct Count {
    std::int64_t cells = 0, occupied = 0;
  };
  Count count(const CellRectangle& rectangle) const;

 private:
  bool on_ground(const Voxel& block) const;
  void mark(const Voxel& block, const VoxelBlock& bits);
  std::size_t patch_of(std::int32_t x, std::int32_t y, std::int32_t z) const;

  CellRectangle ground_;
  std::int32_t low_x_, low_y_, size_x_, size_y_, lowest_z_ = 0, size_z_ = 0;
  std::vector<std::uint8_t> columns_;   // bit k of a cell's byte is the cell k rows farther
  std::vector<std::int32_t> occupied_;  // cells of each patch of the ground, by layer, y, x
};

}  // namespace voxlist
