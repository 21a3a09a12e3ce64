#include "voxlist/viewing/blocks/resampled_block.h"

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

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

// Along one axis: where in the block each voxel of a source block goes; -1: into another block.
using Places = std::array<std::int8_t, kBlockEdge>;

// Those of each source block from `first` to `last`. The axes are alike.
std::vector<Places> places(std::int32_t first, std::int32_t last, std::int32_t block, double map_m,
                           double edge_m) {
  std::vector<Places> all;
  for (std::int32_t source = first; source <= last; ++source) {
    Places& each = all.emplace_back();
    for (std::int32_t i = 0; i < kBlockEdge; ++i) {
      const std::int32_t at = source * kBlockEdge + i;
      const std::int32_t place = resampled({at, at, at}, map_m, edge_m).x - block * kBlockEdge;
      const bool is_inside = place >= 0 && place < kBlockEdge;
      each[static_cast<std::size_t>(i)] = static_cast<std::int8_t>(is_inside ? place : -1);
    }
  }
  return all;
}

void add(const VoxelBlock& source, const Places& x, const Places& y, const Places& z,
         VoxelBlock& bits) {
  for (std::size_t layer = 0; layer < kBlockEdge; ++layer) {
    if (z[layer] < 0) continue;
    std::uint64_t& to = bits[static_cast<std::size_t>(z[layer])];
    for (std::uint64_t word = source[layer]; word != 0; word &= word - 1) {
      const auto bit = static_cast<std::size_t>(std::countr_zero(word));
      const int column = x[bit % 8], row = y[bit / 8];
      if (column >= 0 && row >= 0) to |= std::uint64_t{1} << (column + 8 * row);
    }
  }
}

}  // namespace

VoxelBlock resampled_block(const VoxelMap& map, double edge_m, const Voxel& block) {
  const double map_m = map.resolution_m();
  const auto [low, high] = sources_of(block, edge_m, map_m);
  const auto xs = places(low.x, high.x, block.x, map_m, edge_m);
  const auto ys = places(low.y, high.y, block.y, map_m, edge_m);
  const auto zs = places(low.z, high.z, block.z, map_m, edge_m);
  const auto at = [](std::int32_t i) { return static_cast<std::size_t>(i); };
  VoxelBlock bits{};
  for (std::int32_t z = low.z; z <= high.z; ++z)
    for (std::int32_t y = low.y; y <= high.y; ++y)
      for (std::int32_t x = low.x; x <= high.x; ++x)
        if (const VoxelBlock* source = map.find_block({x, y, z}))
          add(*source, xs[at(x - low.x)], ys[at(y - low.y)], zs[at(z - low.z)], bits);
  return bits;
}

VoxelBox blocks_that_show(const Voxel& block, double from_m, double to_m) {
  return {block_of(resampled(lowest_of(block), from_m, to_m)),
          block_of(resampled(highest_of(block), from_m, to_m))};
}

}  // namespace voxlist::viewing
