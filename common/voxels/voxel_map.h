#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <vector>

#include "voxlist/voxels/numbering.h"
#include "voxlist/voxels/voxel.h"

namespace voxlist {

/// Occupancy of 8 x 8 x 8 voxels: voxel (x, y, z) of the block is bit x + 8 y of word z.
using VoxelBlock = std::array<std::uint64_t, 8>;

/// Voxels along a block's edge.
inline constexpr std::int32_t kBlockEdge = 8;

/// The block that holds a voxel.
inline Voxel block_of(const Voxel& v) { return {v.x >> 3, v.y >> 3, v.z >> 3}; }

/// A box of voxels, both corners included.
struct VoxelBox {
  Voxel lowest, highest;

  bool operator==(const VoxelBox&) const = default;
};

/// A set of occupied voxels for fast insertion and look-up: numbered blocks of 64 bytes. About 4
/// bytes per voxel at 0.02 m. Reading from several threads at once is
/// safe; writing is not.
class VoxelMap {
 public:
  /// Throws std::invalid_argument unless resolution_m > 0.
  explicit VoxelMap(double resolution_m = kFinestResolution_m);

  /// Marks a voxel as occupied. True when it was not before. Precondition: |coordinates| <=
  /// kVoxelLimit.
  bool insert(const Voxel& voxel);

  /// Replaces the contents of a block. True when that changed a voxel. `block` is in block
  /// coordinates (voxel / 8, rounded down). Precondition: its voxels are within kVoxelLimit.
  bool set_block(const Voxel& block, const VoxelBlock& bits);

  /// Marks the voxels of a block's set bits as well. True when one was not occupied before.
  /// Precondition as set_block's.
  bool merge_block(const Voxel& block, const VoxelBlock& bits);

  bool contains(const Voxel& voxel) const;

  double resolution_m() const { return resolution_m_; }
  /// Number of occupied voxels.
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }

  /// The box of the map's blocks with voxels; none without voxels. Looks at every block.
  std::optional<VoxelBox> bounds() const;

  /// Tells states apart: after each change the number is another one, which no other map has had,
  /// replaced maps included. Copies share it, as they hold the same.
  std::uint64_t revision() const { return revision_; }

  /// Number of blocks; block i lies at block_position(i). In order of insertion.
  std::size_t block_count() const { return blocks_.size(); }
  const Voxel& block_position(std::size_t i) const { return positions_.key(i); }
  const VoxelBlock& block(std::size_t i) const { return blocks_[i]; }

  /// An empty map makes room for so many blocks: then it does not grow by doubling.
  void reserve(std::size_t blocks);

  /// The block at a position (block coordinates), or nullptr when nothing was ever put there.
  const VoxelBlock* find_block(const Voxel& block) const;

  /// Bytes held by the blocks and the numbering of their positions.
  std::size_t memory_bytes() const;

  /// A number that depends on the set of voxels and the resolution alone, not on the order of
  /// insertion.
  std::uint64_t hash() const;

  /// Calls visit(Voxel) for every occupied voxel, block by block.
  template <class Visit>
  void for_each_voxel(Visit&& visit) const {
    for (std::size_t i = 0; i < blocks_.size(); ++i)
      visit_block(positions_.key(i), blocks_[i], visit);
  }

  /// Calls visit(Voxel) for every set bit of one block.
  template <class Visit>
  static void visit_block(const Voxel& position, const VoxelBlock& bits, Visit&& visit) {
    for (std::int32_t z = 0; z < kBlockEdge; ++z) {
      for (std::uint64_t word = bits[static_cast<std::size_t>(z)]; word != 0; word &= word - 1) {
        const std::int32_t bit = std::countr_zero(word);
        visit(Voxel{position.x * kBlockEdge + bit % 8, position.y * kBlockEdge + bit / 8,
                    position.z * kBlockEdge + z});
      }
    }
  }

 private:
  VoxelBlock& find_or_add(const Voxel& block);

  double resolution_m_;
  std::size_t size_ = 0;
  std::uint64_t revision_;
  Numbering<Voxel> positions_;
  std::vector<VoxelBlock> blocks_;  // by number of their position
};

}  // namespace voxlist
