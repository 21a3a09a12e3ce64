#include "bus/map_convert.h"

#include <bit>

namespace voxlist {
namespace {

voxel_block_t to_message(const Voxel& position, const VoxelBlock& block) {
  voxel_block_t message{};
  message.x = position.x;
  message.y = position.y;
  message.z = position.z;
  for (std::size_t i = 0; i < block.size(); ++i)
    message.bits[i] = std::bit_cast<std::int64_t>(block[i]);
  return message;
}

VoxelBlock bits_of(const voxel_block_t& message) {
  VoxelBlock block;
  for (std::size_t i = 0; i < block.size(); ++i)
    block[i] = std::bit_cast<std::uint64_t>(message.bits[i]);
  return block;
}

}  // namespace

std::vector<voxel_block_t> to_messages(const VoxelMap& map,
                                       const std::vector<Voxel>& block_positions) {
  std::vector<voxel_block_t> messages;
  messages.reserve(block_positions.size());
  for (const Voxel& position : block_positions) {
    if (const VoxelBlock* block = map.find_block(position))
      messages.push_back(to_message(position, *block));
  }
  return messages;
}

std::vector<voxel_block_t> to_messages(const VoxelMap& map) {
  std::vector<voxel_block_t> messages;
  messages.reserve(map.block_count());
  for (std::size_t i = 0; i < map.block_count(); ++i)
    messages.push_back(to_message(map.block_position(i), map.block(i)));
  return messages;
}

bool apply(const MapChange& change, VoxelMap& map) {
  bool changed = false;
  if (change.is_whole()) {
    changed = !map.empty();
    map = VoxelMap(change.resolution_m);
  }
  for (const voxel_block_t& block : change.blocks)
    changed |= map.set_block({block.x, block.y, block.z}, bits_of(block));
  return changed;
}

}  // namespace voxlist
