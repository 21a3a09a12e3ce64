#include "voxlist/voxels/scan_cells.h"

namespace voxlist {

std::size_t ScanCells::Hash::operator()(const Voxel& tile) const {
  const auto part = [](std::int32_t value, std::size_t factor) {
    return static_cast<std::size_t>(value) * factor;
  };
  return part(tile.x, 73'856'093) ^ part(tile.y, 19'349'663) ^ part(tile.z, 83'492'791);
}

void ScanCells::go_to_tile_of(const Voxel& cell) {
  auto& tile = tiles_[{cell.x >> 6, cell.y >> 6, cell.z >> 6}];
  if (!tile) tile = std::make_unique<Tile>();
  last_tile_ = tile.get();
  last_ = cell;
}

void ScanCells::move_to(VoxelMap& map, std::vector<Voxel>& changed) {
  for (const auto& [at, tile] : tiles_) {
    for (std::int32_t i = 0; i < std::ssize(*tile); ++i) {
      const VoxelBlock& bits = (*tile)[static_cast<std::size_t>(i)];
      if (bits == VoxelBlock{}) continue;
      const Voxel block{at.x * 8 + (i & 7), at.y * 8 + (i >> 3 & 7), at.z * 8 + (i >> 6)};
      if (map.merge_block(block, bits)) changed.push_back(block);
    }
  }
  tiles_.clear();
  last_tile_ = nullptr;
}

}  // namespace voxlist
