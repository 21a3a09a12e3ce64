#include "voxlist/voxels/voids/void_scan.h"

#include <utility>

#include "voxlist/system/check.h"

namespace voxlist {
namespace {

BlockBits without(BlockBits cells, const BlockBits& others) {
  for (std::size_t i = 0; i < cells.size(); ++i) cells[i] &= ~others[i];
  return cells;
}

VoxelBlock both(VoxelBlock a, const VoxelBlock& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] &= b[i];
  return a;
}

// The 2 x 2 x 2 cells of twice the edge of a word of 4 x 4 x 4, as those with x, y and z below 2 in
// such a word.
std::uint64_t halved_word(std::uint64_t word) {
  word |= word >> 1;   // of two along x
  word |= word >> 4;   // along y
  word |= word >> 16;  // along z
  word = (word & 0x10100000101) | (word & 0x40400000404) >> 1;
  word = (word & 0x300000003) | (word & 0x30000000300) >> 4;
  return (word & 0x33) | (word & 0x3300000000) >> 16;
}

}  // namespace

std::uint64_t halved(const BlockBits& cells) {
  std::uint64_t word = 0;
  for (unsigned i = 0; i < cells.size(); ++i)
    word |= halved_word(cells[i]) << (2 * (i & 1) + 4 * (i & 2) + 8 * (i & 4));
  return word;
}

void VoidScan::take(const MarkedScan& scan) {
  if (std::exchange(scan_, scan.number()) == scan.number()) return;
  positions_.clear();
  blocks_.clear();
  passed_.clear();
  const bool is_twice = rule_.cell_m == 2.0 * scan.cell_m();
  VOXLIST_CHECK(is_twice || rule_.cell_m == scan.cell_m(), "cells are those of marks, or twice");
  for (const MarkedScan::Block& block : scan.blocks())
    is_twice ? take_halved(block) : take_block(block);
  find_voids();
}

void VoidScan::take_block(const MarkedScan::Block& block) {
  const std::uint32_t number = number_at(block.at);
  blocks_[number].hit = block.hit;
  passed_[number] = block.early;
}

void VoidScan::take_halved(const MarkedScan::Block& block) {
  const Voxel& at = block.at;
  const std::uint32_t number = number_at({at.x >> 1, at.y >> 1, at.z >> 1});
  const auto word = static_cast<std::size_t>((at.x & 1) | (at.y & 1) << 1 | (at.z & 1) << 2);
  blocks_[number].hit[word] = halved(block.hit);
  passed_[number][word] = halved(block.early);
}

std::uint32_t VoidScan::number_at(const Voxel& at) {
  const std::uint32_t number = positions_.number(at);
  if (number == blocks_.size()) {
    blocks_.push_back({at});
    passed_.emplace_back();
  }
  return number;
}

void VoidScan::find_voids() {
  free_.clear();
  for (std::size_t i = 0; i < blocks_.size(); ++i)
    free_.push_back(in_rows(CellStore::Block(without(passed_[i], blocks_[i].hit))));
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    if (free_[i] == VoxelBlock{}) continue;
    const VoxelBlock wide = with_marked_around(around(blocks_[i].at), rule_.fewest_free);
    blocks_[i].is_void = in_keys(both(free_[i], wide));
  }
}

BlocksAround VoidScan::around(const Voxel& block) const {
  BlocksAround blocks;
  for (std::int32_t i = 0; i < 27; ++i) {
    const std::uint32_t number =
        positions_.find({block.x + i % 3 - 1, block.y + i / 3 % 3 - 1, block.z + i / 9 - 1});
    blocks[static_cast<std::size_t>(i)] =
        number == Numbering<Voxel>::kNone ? nullptr : &free_[number];
  }
  return blocks;
}

}  // namespace voxlist
