#pragma once

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <vector>

#include "voxlist/voxels/numbering.h"
#include "voxlist/voxels/voxel_map.h"

namespace voxlist::matching {

/// A rectangle of the ground, in cells; ends are one past the last.
struct CellRectangle {
  std::int32_t low_x = 0, low_y = 0, end_x = 0, end_y = 0;

  bool holds(const CellRectangle& other) const {
    return other.low_x >= low_x && other.low_y >= low_y && other.end_x <= end_x &&
           other.end_y <= end_y;
  }
};

/// A map ready for counting overlaps, patch by patch as it is asked for: columns half a block wide
/// (0.08 m) and a block (0.16 m) high, or so many blocks, that hold an occupied voxel, or touch the
/// side of one that does. So the lattice pose next to the true one has nearly all of its points in
/// occupied cells, if layers are as high as the scans' rings are apart: planar poses move no point
/// up or down.
class WindowMap {
 public:
  /// Cells along the edge of what one load tells.
  static constexpr std::int32_t kTile = 8;

  /// Layers are 2^doublings blocks high, at most 2^kMostDoublings. The map must outlive it.
  explicit WindowMap(const VoxelMap& map, int doublings = 0)
      : map_(map), doublings_(doublings), revision_(map.revision()) {}

  static constexpr int kMostDoublings = 4;

  /// Makes a rectangle of the ground ready. Costs little where most of it is already (about 20 us
  /// for a square of 2.5 m that is new), and sometimes the whole rectangle, when the robot has gone
  /// far. Places from before must not be used any more.
  void hold(const CellRectangle& needed);

  /// Tells that these blocks of the map have gained or lost voxels.
  void map_changed(const std::vector<Voxel>& blocks);

  /// Whether a rectangle lies on ground that was held, so that tiles of it can be read.
  bool holds(const CellRectangle& rectangle) const { return columns_ && ground_.holds(rectangle); }

  static double cell_m(const VoxelMap& map) { return map.resolution_m() * kBlockEdge / 2; }
  double layer_m() const { return map_.resolution_m() * (kBlockEdge << doublings_); }

  std::int32_t lowest_layer() const { return lowest_z_; }
  std::int32_t layers() const { return size_z_; }

  /// Place of a cell: linear in x, y, and z (the layer, which must be one of the map's).
  std::int64_t place(std::int32_t x, std::int32_t y, std::int32_t z) const {
    return (std::int64_t{z - lowest_z_} * size_y_ + (y - low_y_)) * size_x_ + (x - low_x_);
  }

  /// The tile at a place: bit 8 i + k is cell (x + i, y + k, z). Tiles must lie on ground that is
  /// held.
  std::uint64_t tile(std::int64_t place) const {
    std::uint64_t bits;
    std::memcpy(&bits, columns() + place, sizeof bits);
    return bits;
  }

  /// What tile() reads: a byte a cell, whose bit k is the cell k rows farther, and a row's bytes.
  /// The three tiles behind a tile on the ground, and those of the row above, can be read too.
  const std::uint8_t* columns() const { return columns_.get(); }
  std::int32_t row_bytes() const { return size_x_; }

  /// Cells over a rectangle, rounded to 32 of them, from the lowest occupied layer to the highest,
  /// and the occupied ones among them. Depends on the map and the rectangle alone, which must be
  /// held.
  struct Count {
    std::int64_t cells = 0, occupied = 0;
  };
  Count count(const CellRectangle& rectangle) const;

 private:
  // What stands on a square of the ground.
  struct Patch {
    std::vector<std::uint32_t> blocks;
    std::int32_t lowest_z = 0, highest_z = 0;  // layers of the blocks
    bool ready = false;
  };
  struct Free {
    void operator()(std::uint8_t* bytes) const { std::free(bytes); }
  };

  Patch* find_patch(std::int32_t x, std::int32_t y);
  void list_new_blocks();
  void make_room(const CellRectangle& ground);
  std::int32_t layer_of(const Voxel& block) const { return block.z >> doublings_; }
  void mark(std::uint32_t number);
  void update(std::uint32_t number);
  bool is_ready(const Voxel& block);
  std::uint32_t cells_at(const Voxel& block, std::int32_t dx, std::int32_t dy);
  void mark_again(const Voxel& block);
  void set_cell(std::int32_t x, std::int32_t y, std::int32_t z, bool is_occupied);
  std::size_t counter_of(std::int32_t x, std::int32_t y, std::int32_t z) const;

  const VoxelMap& map_;
  const int doublings_;
  std::uint64_t revision_;  // of the map, when it was last told of
  std::size_t listed_ = 0;  // blocks of the map that patches know of
  std::vector<std::uint32_t>
      marked_;  // by block: the cells that it marks, in a patch that is ready
  Numbering<Voxel> patch_positions_;
  std::vector<Patch> patches_;
  CellRectangle ground_;  // there is room for it
  std::int32_t low_x_ = 0, low_y_ = 0, size_x_ = 0, size_y_ = 0, lowest_z_ = 0, size_z_ = 0;
  std::unique_ptr<std::uint8_t[], Free> columns_;
  std::vector<std::int32_t> occupied_;  // cells of each patch, by layer, y, x
};

}  // namespace voxlist::matching
