#pragma once

#include <vector>

#include "voxlist/voxels/numbering.h"
#include "voxlist/voxels/voxel_map.h"

namespace voxlist {

/// The voxels that one scan hits, on their way into a map: gathered block by block, because
/// neighbouring rays mostly end in one block, which then changes the map once.
class ScanHits {
 public:
  void mark(const Voxel& voxel) {
    const Voxel at = block_of(voxel);
    if (blocks_.empty() || at != positions_.key(last_)) go_to(at);
    blocks_[last_][static_cast<std::size_t>(voxel.z & 7)] |= std::uint64_t{1}
                                                             << ((voxel.x & 7) + 8 * (voxel.y & 7));
  }

  /// Puts the voxels into a map; the positions of the blocks that this changed, ascending.
  std::vector<Voxel> put_into(VoxelMap& map) const;

  /// Calls visit(block position, bits) for each block, in the order in which they were met.
  template <class Visit>
  void for_each_block(const Visit& visit) const {
    for (std::size_t i = 0; i < blocks_.size(); ++i) visit(positions_.key(i), blocks_[i]);
  }

  /// No voxels are left.
  void clear();

 private:
  void go_to(const Voxel& block);

  Numbering<Voxel> positions_;  // of blocks
  std::vector<VoxelBlock> blocks_;
  std::size_t last_ = 0;  // the block that was marked last
};

}  // namespace voxlist
