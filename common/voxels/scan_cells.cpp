#include "voxlist/voxels/scan_cells.h"

namespace voxlist {

void ScanCells::go_to_tile_of(const Voxel& cell) {
  const std::uint32_t number = positions_.number({cell.x >> 6, cell.y >> 6, cell.z >> 6});
  if (number == tiles_.size()) tiles_.push_back(std::make_unique<Tile>());
  last_tile_ = tiles_[number].get();
  last_ = cell;
}

void ScanCells::move_to(VoxelMap& map, std::vector<Voxel>& changed) {
  for_each_block([&](const Voxel& block, const VoxelBlock& bits) {
    if (map.merge_block(block, bits)) changed.push_back(block);
  });
  clear();
}

void ScanCells::clear() {
  positions_.clear();
  tiles_.clear();
  last_tile_ = nullptr;
}

}  // namespace voxlist
