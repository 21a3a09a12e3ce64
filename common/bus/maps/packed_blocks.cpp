#include "voxlist/bus/maps/packed_blocks.h"

#include <array>
#include <cstring>
#include <string_view>

namespace voxlist::bus {
namespace {

template <class T>
void put(const T& value, std::string& bytes) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

template <class T>
T take(std::string_view& bytes) {
  T value;
  std::memcpy(&value, bytes.data(), sizeof value);
  bytes.remove_prefix(sizeof value);
  return value;
}

// Its place, which words follow (a bit each), and these.
void put(const voxel_block_t& block, std::string& bytes) {
  put(std::array{block.x, block.y, block.z}, bytes);
  unsigned set = 0;
  for (unsigned i = 0; i < std::size(block.bits); ++i) set |= unsigned{block.bits[i] != 0} << i;
  put(static_cast<std::uint8_t>(set), bytes);
  for (const std::int64_t word : block.bits)
    if (word != 0) put(word, bytes);
}

voxel_block_t take_block(std::string_view& bytes) {
  voxel_block_t block{};
  const auto [x, y, z] = take<std::array<std::int32_t, 3>>(bytes);
  block.x = x, block.y = y, block.z = z;
  const unsigned set = take<std::uint8_t>(bytes);
  for (unsigned i = 0; i < std::size(block.bits); ++i)
    if ((set >> i & 1U) != 0) block.bits[i] = take<std::int64_t>(bytes);
  return block;
}

}  // namespace

PackedBlocks::PackedBlocks(const MapBlocks& blocks)
    : occupied_(static_cast<std::uint32_t>(blocks.occupied.size())),
      passed_(static_cast<std::uint32_t>(blocks.passed.size())) {
  for (const voxel_block_t& block : blocks.occupied) put(block, bytes_);
  for (const voxel_block_t& block : blocks.passed) put(block, bytes_);
  bytes_.shrink_to_fit();
}

MapBlocks PackedBlocks::unpacked() const {
  std::string_view bytes = bytes_;
  MapBlocks blocks;
  blocks.occupied.reserve(occupied_);
  blocks.passed.reserve(passed_);
  for (std::uint32_t i = 0; i < occupied_; ++i) blocks.occupied.push_back(take_block(bytes));
  for (std::uint32_t i = 0; i < passed_; ++i) blocks.passed.push_back(take_block(bytes));
  return blocks;
}

}  // namespace voxlist::bus
