#pragma once

#include <vector>

#include "voxlist/voxels/numbering.h"
#include "voxlist/voxels/voids/free_neighbours.h"
#include "voxlist/voxels/voids/marked_scan.h"

namespace voxlist {

/// When a scan sees that a cell is void: rays crossed it and nothing in it was hit, and the same
/// holds for at least so many of the 27 cells about it, itself included. Rays are followed up to
/// kVoidGap_m before their ends.
struct VoidRule {
  double cell_m;  ///< that of a MarkedScan, or twice as much
  unsigned fewest_free;
};

/// The cells that one scan hits, and those that it sees to be void. A void is larger than a thin
/// thing that rays miss: a pole fits into a gap between rays, but not into many side by side.
class VoidScan {
 public:
  explicit VoidScan(const VoidRule& rule) : rule_(rule) {}

  /// Takes the cells of a scan in the place of those before.
  void take(const MarkedScan& scan);

  struct Block {
    Voxel at;
    BlockBits hit{}, is_void{};
  };

  /// Blocks that were passed or hit, always in the same order.
  const std::vector<Block>& blocks() const { return blocks_; }

 private:
  void take_block(const MarkedScan::Block& block);
  void take_halved(const MarkedScan::Block& block);
  std::uint32_t number_at(const Voxel& at);
  void find_voids();
  BlocksAround around(const Voxel& block) const;

  VoidRule rule_;
  Numbering<Voxel> positions_;
  std::vector<BlockBits> passed_;  // by number
  std::vector<VoxelBlock> free_;   // by number
  std::vector<Block> blocks_;      // by number
  std::uint64_t scan_ = 0;         // its MarkedScan::number()
};

/// The cells of twice the edge with a cell in a block: 64 of them, one word of a block's eight,
/// which is the place of the block in a cube of eight.
std::uint64_t halved(const BlockBits& cells);

}  // namespace voxlist
