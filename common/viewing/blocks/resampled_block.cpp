#include "voxlist/viewing/blocks/resampled_block.h"

namespace voxlist::viewing {
namespace {

Voxel resampled(const Voxel& voxel, double from_m, double to_m) {
  return voxel_at(center(voxel, from_m), to_m);
}

Voxel lowest_of(const Voxel& block) {
  return {block.x * kBlockEdge, block.y * kBlockEdge, block.z * kBlockEdge};
}

Voxel highest_of(const Voxel& block) {
  const Voxel low = lowest_of(block);
  return {low.x + kBlockEdge - 1, low.y + kBlockEdge - 1, low.z + kBlockEdge - 1};
}

// The map's blocks of which voxels may have their centre in a block of edge_m.
VoxelBox sources_of(const Voxel& block, double edge_m, double map_m) {
  const Eigen::Vector3d low = Eigen::Vector3d(block.x, block.y, block.z) * kBlockEdge * edge_m;
  const Eigen::Vector3d high = low + Eigen::Vector3d::Constant(kBlockEdge * edge_m);
  return {block_of(voxel_at(low, map_m)), block_of(voxel_at(high, map_m))};
}

void mark(const Voxel& voxel, VoxelBlock& bits) {
  const int bit = (voxel.x & 7) + 8 * (voxel.y & 7);
  bits[static_cast<std::size_t>(voxel.z & 7)] |= std::uint64_t{1} << bit;
}

}  // namespace

VoxelBlock resampled_block(const VoxelMap& map, double edge_m, const Voxel& block) {
  const VoxelBox sources = sources_of(block, edge_m, map.resolution_m());
  VoxelBlock bits{};
  const auto take = [&](const Voxel& voxel) {
    const Voxel there = resampled(voxel, map.resolution_m(), edge_m);
    if (block_of(there) == block) mark(there, bits);
  };
  for (std::int32_t z = sources.lowest.z; z <= sources.highest.z; ++z)
    for (std::int32_t y = sources.lowest.y; y <= sources.highest.y; ++y)
      for (std::int32_t x = sources.lowest.x; x <= sources.highest.x; ++x)
        if (const VoxelBlock* source = map.find_block({x, y, z}))
          VoxelMap::visit_block({x, y, z}, *source, take);
  return bits;
}

VoxelBox blocks_that_show(const Voxel& block, double from_m, double to_m) {
  return {block_of(resampled(lowest_of(block), from_m, to_m)),
          block_of(resampled(highest_of(block), from_m, to_m))};
}

}  // namespace voxlist::viewing
