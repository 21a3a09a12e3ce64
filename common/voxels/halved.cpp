#include "voxlist/voxels/halved.h"

namespace voxlist {
namespace {

// Two slices of 8 x 8 voxels, one above the other, as 4 x 4 in the low corner of a slice. Pairs
// meet in the even bits along x, then along y; what is between is squeezed out.
std::uint64_t halved_slices(std::uint64_t lower, std::uint64_t upper) {
  std::uint64_t s = lower | upper;
  s |= s >> 1;
  s |= s >> 8;
  s &= 0x0055'0055'0055'0055;
  s = (s | s >> 1) & 0x0033'0033'0033'0033;
  s = (s | s >> 2) & 0x000f'000f'000f'000f;
  s = (s | s >> 8) & 0x0000'0f0f'0000'0f0f;
  return (s | s >> 16) & 0x0000'0000'0f0f'0f0f;
}

}  // namespace

VoxelBlock halved_block(const VoxelBlock& block) {
  VoxelBlock half{};
  for (std::size_t z = 0; z < half.size() / 2; ++z)
    half[z] = halved_slices(block[2 * z], block[2 * z + 1]);
  return half;
}

VoxelMap halved(const VoxelMap& map) {
  constexpr int kHalf = kBlockEdge / 2;
  VoxelMap result(2.0 * map.resolution_m());
  for (std::size_t i = 0; i < map.block_count(); ++i) {
    const Voxel& at = map.block_position(i);
    const VoxelBlock half = halved_block(map.block(i));
    // The block's eighth of the large block that it is in.
    const int corner = kHalf * (at.x & 1) + kHalf * kBlockEdge * (at.y & 1);
    const auto first = static_cast<std::size_t>(kHalf * (at.z & 1));
    VoxelBlock to{};
    for (std::size_t z = 0; z < kHalf; ++z) to[first + z] = half[z] << corner;
    result.merge_block({at.x >> 1, at.y >> 1, at.z >> 1}, to);
  }
  return result;
}

}  // namespace voxlist
