#pragma once

#include <array>
#include <memory>
#include <vector>

#include "voxlist/voxels/numbering.h"
#include "voxlist/voxels/voxel_map.h"

namespace voxlist {

/// The cells that one scan's rays pass, on their way into a map: marked in dense tiles of 64 x 64 x
/// 64 cells, because a ray stays in a tile for some 40 cells and needs no look-up there.
class ScanCells {
 public:
  void mark(const Voxel& cell) {
    if (!in_last_tile(cell)) go_to_tile_of(cell);
    (*last_tile_)[block_in_tile(cell)][static_cast<std::size_t>(cell.z & 7)] |=
        std::uint64_t{1} << ((cell.x & 7) + 8 * (cell.y & 7));
  }

  /// Puts the cells into a map and appends the blocks that this changed, each once, tile by
  /// tile in the order in which they were met. No cells are left here.
  void move_to(VoxelMap& map, std::vector<Voxel>& changed);

  /// Calls visit(block position, bits) for each block with cells, tile by tile.
  template <class Visit>
  void for_each_block(const Visit& visit) const {
    for (std::size_t t = 0; t < tiles_.size(); ++t) {
      const Voxel& at = positions_.key(t);
      for (std::int32_t i = 0; i < 512; ++i) {
        const VoxelBlock& bits = (*tiles_[t])[static_cast<std::size_t>(i)];
        if (bits == VoxelBlock{}) continue;
        visit(Voxel{at.x * 8 + (i & 7), at.y * 8 + (i >> 3 & 7), at.z * 8 + (i >> 6)}, bits);
      }
    }
  }

  /// No cells are left.
  void clear();

  /// Bytes held: 32 kB a tile.
  std::size_t memory_bytes() const { return tiles_.size() * sizeof(Tile); }

 private:
  // 8 x 8 x 8 blocks, x fastest.
  using Tile = std::array<VoxelBlock, 512>;

  static std::size_t block_in_tile(const Voxel& cell) {
    return static_cast<std::size_t>((cell.x >> 3 & 7) | (cell.y & 0x38) | (cell.z & 0x38) << 3);
  }

  bool in_last_tile(const Voxel& v) const {
    return last_tile_ && ((v.x ^ last_.x) | (v.y ^ last_.y) | (v.z ^ last_.z)) >> 6 == 0;
  }

  void go_to_tile_of(const Voxel& cell);

  Numbering<Voxel> positions_;  // of tiles, in their own edges
  std::vector<std::unique_ptr<Tile>> tiles_;
  // The tile that was marked last, and a cell in it.
  Tile* last_tile_ = nullptr;
  Voxel last_;
};

}  // namespace voxlist
