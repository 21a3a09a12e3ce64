#include "voxlist/voxels/counters/cut.h"

#include <bit>
#include <cmath>
#include <numeric>

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

Voxel last_cell(const Voxel& block) {
  constexpr std::int32_t kLast = kBlockEdge - 1;
  const Voxel first = first_cell(block);
  return {first.x + kLast, first.y + kLast, first.z + kLast};
}

template <class Visit>
void for_each_in(const VoxelBox& box, const Visit& visit) {
  for (std::int32_t z = box.lowest.z; z <= box.highest.z; ++z)
    for (std::int32_t y = box.lowest.y; y <= box.highest.y; ++y)
      for (std::int32_t x = box.lowest.x; x <= box.highest.x; ++x) visit(Voxel{x, y, z});
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

// The blocks that may have cells in a larger one; a block more on each side, for rounding.
VoxelBox smaller_blocks(const Voxel& larger_block, double larger_m, double smaller_m) {
  const double ratio = larger_m / smaller_m;
  const auto first = [&](std::int32_t at) {
    return static_cast<std::int32_t>(std::floor(at * ratio)) - 1;
  };
  const auto last = [&](std::int32_t at) {
    return static_cast<std::int32_t>(std::floor((at + 1) * ratio)) + 1;
  };
  return {{first(larger_block.x), first(larger_block.y), first(larger_block.z)},
          {last(larger_block.x), last(larger_block.y), last(larger_block.z)}};
}

}  // namespace

CutMap::CutMap(const CounterMap& map, double resolution_m, const std::optional<VoxelBox>& box)
    : from_m_(map.resolution_m()), box_(box), part_(resolution_m, map.rule()) {
  VOXLIST_CHECK(resolution_m >= from_m_, "cells can only become larger");
  std::vector<std::uint32_t> all(map.block_count());
  std::iota(all.begin(), all.end(), 0u);
  update(map, all);
}

void CutMap::update(const CounterMap& map, std::span<const std::uint32_t> changed) {
  Numbering<Voxel> larger;
  for (const std::uint32_t number : changed) {
    const Voxel& block = map.block_position(number);
    if (!box_ || overlaps(block, *box_))
      for_each_in(larger_blocks(block), [&](const Voxel& at) { larger.number(at); });
  }
  for (const Voxel& block : larger.keys()) make_anew(map, block);
}

Voxel CutMap::larger_cell(const Voxel& cell) const {
  return from_m_ == part_.resolution_m() ? cell
                                         : voxel_at(center(cell, from_m_), part_.resolution_m());
}

VoxelBox CutMap::larger_blocks(const Voxel& block) const {
  return {block_of(larger_cell(first_cell(block))), block_of(larger_cell(last_cell(block)))};
}

void CutMap::make_anew(const CounterMap& map, const Voxel& larger_block) {
  part_.forget({larger_block});
  if (from_m_ == part_.resolution_m())
    return raise(map, map.find_block(larger_block), larger_block);
  for_each_in(smaller_blocks(larger_block, part_.resolution_m(), from_m_), [&](const Voxel& at) {
    const std::uint32_t number = map.find_block(at);
    if (number != Numbering<Voxel>::kNone) raise(map, number, larger_block);
  });
}

// Adds those cells of a block that lie in the larger block.
void CutMap::raise(const CounterMap& map, std::size_t block, const Voxel& larger_block) {
  for_each_known(map, block, [&](const Voxel& cell, unsigned value) {
    const Voxel larger = larger_cell(cell);
    if ((box_ && !is_in(cell, *box_)) || block_of(larger) != larger_block) return;
    CounterBlock& counters = part_.counters_at(larger_block);
    const std::size_t bit = bit_in_block(larger);
    if (counters.value(bit) < value) counters.set(bit, value);
  });
}

}  // namespace voxlist
