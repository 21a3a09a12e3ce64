#include "voxlist/voxels/voids/free_space.h"

#include <algorithm>

#include "voxlist/voxels/voids/free_neighbours.h"

namespace voxlist {
namespace {

// Where there is nothing to be held, no block is made.
void set(VoxelMap& map, const Voxel& at, const BlockBits& bits, std::vector<Voxel>& changed) {
  const bool is_new = bits != BlockBits{} || map.find_block(at) != nullptr;
  if (is_new && map.set_block(at, in_rows(CellStore::Block(bits)))) changed.push_back(at);
}

}  // namespace

FreeSpace::FreeSpace()
    : counters_(kPassedResolution_m),
      map_{VoxelMap(kPassedResolution_m), VoxelMap(kPassedResolution_m)} {}

ChangedBlocks FreeSpace::follow() {
  ChangedBlocks changed;
  changed.from = map_.revision();
  for (const std::uint32_t number : counters_.take_changed()) {
    const Voxel at = counters_.block_position(number);
    const BlockBits occupied = counters_.occupied(number);
    BlockBits free = counters_.known(number);
    for (std::size_t i = 0; i < free.size(); ++i) free[i] &= ~occupied[i];
    set(map_.occupied, at, occupied, changed.occupied);
    set(map_.passed, at, free, changed.passed);
  }
  std::sort(changed.occupied.begin(), changed.occupied.end());
  std::sort(changed.passed.begin(), changed.passed.end());
  changed.to = map_.revision();
  return changed;
}

}  // namespace voxlist
