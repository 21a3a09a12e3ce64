#include "voxlist/voxels/counters/cut.h"

#include <algorithm>
#include <bit>

#include "voxlist/system/check.h"

namespace voxlist {
namespace {

bool is_in(const Voxel& v, const VoxelBox& box) {
  return v.x >= box.lowest.x && v.x <= box.highest.x && v.y >= box.lowest.y &&
         v.y <= box.highest.y && v.z >= box.lowest.z && v.z <= box.highest.z;
}

bool overlaps(const Voxel& block, const VoxelBox& box) {
  const Voxel low = block_of(box.lowest), high = block_of(box.highest);
  return is_in(block, {low, high});
}

Voxel first_cell(const Voxel& block) {
  return {block.x * kBlockEdge, block.y * kBlockEdge, block.z * kBlockEdge};
}

// Calls visit(cell, stored value) for each known cell of a block.
template <class Visit>
void for_each_known(const CounterMap& map, std::size_t block, const Visit& visit) {
  const Voxel first = first_cell(map.block_position(block));
  const BlockBits known = map.known(block);
  for (std::size_t w = 0; w < known.size(); ++w) {
    for (std::uint64_t left = known[w]; left != 0; left &= left - 1) {
      const std::size_t bit = 64 * w + static_cast<std::size_t>(std::countr_zero(left));
      const Voxel inside = cell_of_bit(bit);
      visit(Voxel{first.x + inside.x, first.y + inside.y, first.z + inside.z},
            map.block(block).value(bit));
    }
  }
}

class Larger {
 public:
  Larger(const CounterMap& map, double resolution_m)
      : from_m_(map.resolution_m()), out_(resolution_m, map.rule()) {}

  void raise(const Voxel& cell, unsigned value) {
    const Voxel larger = larger_cell(cell);
    CounterBlock& block = out_.counters_at(block_of(larger));
    const std::size_t bit = bit_in_block(larger);
    if (block.value(bit) < value) block.set(bit, value);
  }

  CounterMap take() { return std::move(out_); }

 private:
  Voxel larger_cell(const Voxel& cell) const {
    return from_m_ == out_.resolution_m() ? cell
                                          : voxel_at(center(cell, from_m_), out_.resolution_m());
  }

  double from_m_;
  CounterMap out_;
};

}  // namespace

CounterMap cut(const CounterMap& map, double resolution_m, const std::optional<VoxelBox>& box) {
  VOXLIST_CHECK(resolution_m >= map.resolution_m(), "cells can only become larger");
  Larger larger(map, resolution_m);
  for (std::size_t i = 0; i < map.block_count(); ++i) {
    if (box && !overlaps(map.block_position(i), *box)) continue;
    for_each_known(map, i, [&](const Voxel& cell, unsigned value) {
      if (!box || is_in(cell, *box)) larger.raise(cell, value);
    });
  }
  return larger.take();
}

}  // namespace voxlist
