#include "voxlist/voxels/voxel_map.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>

namespace voxlist {
namespace {

constexpr std::int32_t kFree = -1;
constexpr std::size_t kFirstDirectorySize = 1024;

// Finaliser of splitmix64: every input bit reaches every output bit.
std::uint64_t mix(std::uint64_t value) {
  value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9u;
  value = (value ^ (value >> 27)) * 0x94d049bb133111ebu;
  return value ^ (value >> 31);
}

// Block coordinates fit 20 bits (kVoxelLimit / 8), so the packing is one to one.
std::uint64_t pack(const Voxel& block) {
  const auto part = [](std::int32_t value) {
    return static_cast<std::uint64_t>(value + (1 << 20)) & 0x1fffff;
  };
  return part(block.x) | part(block.y) << 21 | part(block.z) << 42;
}

std::size_t voxels_in(const VoxelBlock& block) {
  std::size_t count = 0;
  for (const std::uint64_t word : block) count += static_cast<std::size_t>(std::popcount(word));
  return count;
}

std::size_t word_of(const Voxel& v) { return static_cast<std::size_t>(v.z & 7); }
std::uint64_t bit_of(const Voxel& v) { return std::uint64_t{1} << ((v.x & 7) + 8 * (v.y & 7)); }

}  // namespace

VoxelMap::VoxelMap(double resolution_m)
    : resolution_m_(resolution_m), directory_(kFirstDirectorySize, kFree) {
  if (!(resolution_m > 0.0)) throw std::invalid_argument("VoxelMap: resolution must be above 0 m");
}

bool VoxelMap::insert(const Voxel& voxel) {
  std::uint64_t& word = find_or_add(block_of(voxel))[word_of(voxel)];
  const std::uint64_t bit = bit_of(voxel);
  if (word & bit) return false;
  word |= bit;
  ++size_;
  return true;
}

bool VoxelMap::set_block(const Voxel& block, const VoxelBlock& bits) {
  VoxelBlock& held = find_or_add(block);
  if (held == bits) return false;
  size_ = size_ - voxels_in(held) + voxels_in(bits);
  held = bits;
  return true;
}

bool VoxelMap::merge_block(const Voxel& block, const VoxelBlock& bits) {
  VoxelBlock& held = find_or_add(block);
  const std::size_t before = voxels_in(held);
  for (std::size_t i = 0; i < held.size(); ++i) held[i] |= bits[i];
  const std::size_t news = voxels_in(held) - before;
  size_ += news;
  return news > 0;
}

bool VoxelMap::contains(const Voxel& voxel) const {
  const VoxelBlock* block = find_block(block_of(voxel));
  return block && ((*block)[word_of(voxel)] & bit_of(voxel)) != 0;
}

const VoxelBlock* VoxelMap::find_block(const Voxel& block) const {
  const std::int32_t index = directory_[slot_of(block)];
  return index == kFree ? nullptr : &blocks_[static_cast<std::size_t>(index)];
}

std::size_t VoxelMap::memory_bytes() const {
  return directory_.capacity() * sizeof(std::int32_t) + positions_.capacity() * sizeof(Voxel) +
         blocks_.capacity() * sizeof(VoxelBlock);
}

std::uint64_t VoxelMap::hash() const {
  std::vector<std::size_t> order(blocks_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](auto a, auto b) { return positions_[a] < positions_[b]; });
  std::uint64_t hash = mix(std::bit_cast<std::uint64_t>(resolution_m_));
  for (const std::size_t i : order) {
    if (blocks_[i] == VoxelBlock{}) continue;
    hash = mix(hash ^ pack(positions_[i]));
    for (const std::uint64_t word : blocks_[i]) hash = mix(hash ^ word);
  }
  return hash;
}

std::size_t VoxelMap::slot_of(const Voxel& block) const {
  const std::size_t mask = directory_.size() - 1;
  std::size_t slot = mix(pack(block)) & mask;
  while (directory_[slot] != kFree &&
         positions_[static_cast<std::size_t>(directory_[slot])] != block) {
    slot = (slot + 1) & mask;
  }
  return slot;
}

VoxelBlock& VoxelMap::find_or_add(const Voxel& block) {
  std::size_t slot = slot_of(block);
  if (directory_[slot] == kFree) {
    if (2 * (blocks_.size() + 1) > directory_.size()) {
      grow_directory();
      slot = slot_of(block);
    }
    directory_[slot] = static_cast<std::int32_t>(blocks_.size());
    positions_.push_back(block);
    blocks_.emplace_back();
  }
  return blocks_[static_cast<std::size_t>(directory_[slot])];
}

void VoxelMap::grow_directory() {
  directory_.assign(2 * directory_.size(), kFree);
  for (std::size_t i = 0; i < blocks_.size(); ++i)
    directory_[slot_of(positions_[i])] = static_cast<std::int32_t>(i);
}

}  // namespace voxlist
