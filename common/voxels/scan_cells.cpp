#include "voxlist/voxels/scan_cells.h"

namespace voxlist {

void ScanCells::go_to_tile_of(const Voxel& cell) {
  const std::uint32_t number = positions_.number({cell.x >> 6, cell.y >> 6, cell.z >> 6});
  if (number == tiles_.size()) tiles_.push_back(std::make_unique<Tile>());
  last_tile_ = tiles_[number].get();
  last_ = cell;
}

void ScanCells::move_to(VoxelMap& map, std::vector<Voxel>& changed) {
  for (std::size_t t = 0; t < tiles_.size(); ++t) {
    const Voxel& at = positions_.key(t);
    const Tile& tile = *tiles_[t];
    for (std::int32_t i = 0; i < std::ssize(tile); ++i) {
      const VoxelBlock& bits = tile[static_cast<std::size_t>(i)];
      if (bits == VoxelBlock{}) continue;
      const Voxel block{at.x * 8 + (i & 7), at.y * 8 + (i >> 3 & 7), at.z * 8 + (i >> 6)};
      if (map.merge_block(block, bits)) changed.push_back(block);
    }
  }
  positions_.clear();
  tiles_.clear();
  last_tile_ = nullptr;
}

}  // namespace voxlist
