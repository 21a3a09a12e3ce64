#include "voxlist/voxels/voxel_map.h"

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace voxlist {
namespace {

// One count for all maps: a map that takes another's place is told apart, too.
std::uint64_t next_revision() {
  static std::atomic<std::uint64_t> last{0};
  return last.fetch_add(1, std::memory_order_relaxed) + 1;
}

std::size_t voxels_in(const VoxelBlock& block) {
  std::size_t count = 0;
  for (const std::uint64_t word : block) count += static_cast<std::size_t>(std::popcount(word));
  return count;
}

[[maybe_unused]] bool within_limit(const Voxel& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}) <= kVoxelLimit;
}

[[maybe_unused]] bool block_within_limit(const Voxel& block) {
  constexpr std::int32_t kMost = kVoxelLimit / kBlockEdge;
  return std::max({std::abs(block.x), std::abs(block.y), std::abs(block.z)}) <= kMost;
}

std::size_t word_of(const Voxel& v) { return static_cast<std::size_t>(v.z & 7); }
std::uint64_t bit_of(const Voxel& v) { return std::uint64_t{1} << ((v.x & 7) + 8 * (v.y & 7)); }

}  // namespace

VoxelMap::VoxelMap(double resolution_m) : resolution_m_(resolution_m), revision_(next_revision()) {
  if (!(resolution_m > 0.0)) throw std::invalid_argument("VoxelMap: resolution must be above 0 m");
}

bool VoxelMap::insert(const Voxel& voxel) {
  VOXLIST_CHECK(within_limit(voxel), "a voxel beyond kVoxelLimit");
  std::uint64_t& word = find_or_add(block_of(voxel))[word_of(voxel)];
  const std::uint64_t bit = bit_of(voxel);
  if (word & bit) return false;
  word |= bit;
  ++size_;
  revision_ = next_revision();
  return true;
}

bool VoxelMap::set_block(const Voxel& block, const VoxelBlock& bits) {
  VOXLIST_CHECK(block_within_limit(block), "a block beyond kVoxelLimit");
  VoxelBlock& held = find_or_add(block);
  if (held == bits) return false;
  size_ = size_ - voxels_in(held) + voxels_in(bits);
  held = bits;
  revision_ = next_revision();
  return true;
}

bool VoxelMap::merge_block(const Voxel& block, const VoxelBlock& bits) {
  VOXLIST_CHECK(block_within_limit(block), "a block beyond kVoxelLimit");
  VoxelBlock& held = find_or_add(block);
  const std::size_t before = voxels_in(held);
  for (std::size_t i = 0; i < held.size(); ++i) held[i] |= bits[i];
  const std::size_t news = voxels_in(held) - before;
  if (news == 0) return false;
  size_ += news;
  revision_ = next_revision();
  return true;
}

bool VoxelMap::contains(const Voxel& voxel) const {
  const VoxelBlock* block = find_block(block_of(voxel));
  return block && ((*block)[word_of(voxel)] & bit_of(voxel)) != 0;
}

const VoxelBlock* VoxelMap::find_block(const Voxel& block) const {
  const std::uint32_t number = positions_.find(block);
  return number == Numbering<Voxel>::kNone ? nullptr : &blocks_[number];
}

void VoxelMap::reserve(std::size_t blocks) {
  VOXLIST_CHECK(blocks_.empty(), "room is made before the first block");
  positions_ = Numbering<Voxel>(blocks);
  blocks_.reserve(blocks);
}

std::size_t VoxelMap::memory_bytes() const {
  return positions_.memory_bytes() + blocks_.capacity() * sizeof(VoxelBlock);
}

std::optional<VoxelBox> VoxelMap::bounds() const {
  if (empty()) return std::nullopt;
  constexpr std::int32_t kFar = std::numeric_limits<std::int32_t>::max();
  Voxel low{kFar, kFar, kFar}, high{-kFar, -kFar, -kFar};
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    const Voxel& at = positions_.key(i);
    if (blocks_[i] == VoxelBlock{}) continue;
    low = {std::min(low.x, at.x), std::min(low.y, at.y), std::min(low.z, at.z)};
    high = {std::max(high.x, at.x), std::max(high.y, at.y), std::max(high.z, at.z)};
  }
  const auto first = [](std::int32_t block) { return block * kBlockEdge; };
  const auto last = [&](std::int32_t block) { return first(block) + kBlockEdge - 1; };
  return VoxelBox{{first(low.x), first(low.y), first(low.z)},
                  {last(high.x), last(high.y), last(high.z)}};
}

std::uint64_t VoxelMap::hash() const {
  std::vector<std::size_t> order(blocks_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](auto a, auto b) { return positions_.key(a) < positions_.key(b); });
  std::uint64_t hash = mixed(std::bit_cast<std::uint64_t>(resolution_m_));
  for (const std::size_t i : order) {
    if (blocks_[i] == VoxelBlock{}) continue;
    hash = mixed(hash ^ key_of(positions_.key(i)));
    for (const std::uint64_t word : blocks_[i]) hash = mixed(hash ^ word);
  }
  return hash;
}

VoxelBlock& VoxelMap::find_or_add(const Voxel& block) {
  const std::uint32_t number = positions_.number(block);
  if (number == blocks_.size()) blocks_.emplace_back();
  return blocks_[number];
}

}  // namespace voxlist
