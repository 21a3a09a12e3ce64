#include "voxlist/voxels/voids/void_cells.h"

#include <algorithm>
#include <cmath>

namespace voxlist {
namespace {

// Bits from one to another of eight, cut to 0..7.
std::uint64_t run(std::int32_t first, std::int32_t last) {
  std::uint64_t bits = 0;
  for (std::int32_t i = std::max(first, 0); i <= std::min(last, kBlockEdge - 1); ++i)
    bits |= std::uint64_t{1} << i;
  return bits;
}

// Cells at the lowest count, which is stored as 1.
BlockBits lowest(const CounterBlock& block) {
  const auto& p = block.planes;
  BlockBits bits;
  for (std::size_t i = 0; i < bits.size(); ++i) bits[i] = p[0][i] & ~(p[1][i] | p[2][i] | p[3][i]);
  return bits;
}

}  // namespace

VoxelBlock voxels_in(const VoxelBox& box, const Voxel& block) {
  const Voxel first{block.x * kBlockEdge, block.y * kBlockEdge, block.z * kBlockEdge};
  const std::uint64_t row = run(box.lowest.x - first.x, box.highest.x - first.x);
  const std::uint64_t rows = run(box.lowest.y - first.y, box.highest.y - first.y);
  const std::uint64_t layers = run(box.lowest.z - first.z, box.highest.z - first.z);
  std::uint64_t layer = 0;
  for (int y = 0; y < kBlockEdge; ++y)
    if ((rows >> y & 1) != 0) layer |= row << kBlockEdge * y;
  VoxelBlock bits{};
  for (std::size_t z = 0; z < bits.size(); ++z)
    if ((layers >> z & 1) != 0) bits[z] = layer;
  return bits;
}

VoidCells::VoidCells(double cell_m, double voxel_m)
    : voxels_(static_cast<std::int32_t>(std::lround(cell_m / voxel_m))),
      counters_(cell_m, kVoidCounts) {}

VoidCells::Change VoidCells::count(const VoidScan::Block& seen) {
  Change change{seen.at};
  if (seen.hit == BlockBits{} && seen.is_void == BlockBits{}) return change;
  counters_.counters_at(seen.at);
  const std::size_t number = counters_.find_block(seen.at);
  const BlockBits held_before = counters_.occupied(number);
  const BlockBits lowest_before = lowest(counters_.block(number));
  counters_.add(seen.at, CellStore::Block(seen.is_void), CellStore::Block(seen.hit));
  const BlockBits held = counters_.occupied(number), empty = lowest(counters_.block(number));
  for (std::size_t i = 0; i < held.size(); ++i) {
    change.turned[i] = held[i] ^ held_before[i];
    change.emptied[i] = empty[i] & ~lowest_before[i];
  }
  return change;
}

BlockBits VoidCells::doubted(const VoidScan::Block& seen) const {
  const std::uint32_t number = counters_.find_block(seen.at);
  if (number == Numbering<Voxel>::kNone) return {};
  BlockBits bits = counters_.occupied(number);
  for (std::size_t i = 0; i < bits.size(); ++i) bits[i] &= seen.is_void[i];
  return bits;
}

VoxelBox VoidCells::voxels_of(const Voxel& cell) const {
  const Voxel first{cell.x * voxels_, cell.y * voxels_, cell.z * voxels_};
  return {first, {first.x + voxels_ - 1, first.y + voxels_ - 1, first.z + voxels_ - 1}};
}

VoxelBlock VoidCells::void_voxels(const Voxel& block) const {
  const auto cell_of = [&](std::int32_t voxel) { return floor_div(voxel, voxels_); };
  const Voxel low{block.x * kBlockEdge, block.y * kBlockEdge, block.z * kBlockEdge};
  constexpr std::int32_t kLast = kBlockEdge - 1;
  VoxelBlock bits{};
  for (std::int32_t z = cell_of(low.z); z <= cell_of(low.z + kLast); ++z) {
    for (std::int32_t y = cell_of(low.y); y <= cell_of(low.y + kLast); ++y) {
      for (std::int32_t x = cell_of(low.x); x <= cell_of(low.x + kLast); ++x) {
        if (!is_void({x, y, z})) continue;
        const VoxelBlock part = voxels_in(voxels_of({x, y, z}), block);
        for (std::size_t i = 0; i < bits.size(); ++i) bits[i] |= part[i];
      }
    }
  }
  return bits;
}

}  // namespace voxlist
