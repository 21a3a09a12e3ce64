#include "voxlist/bus/maps/map_convert.h"

#include <bit>
#include <vector>
#include <voxlist/voxel_block_t.hpp>

#include "voxlist/system/check.h"

namespace voxlist::bus {
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

// Room for a whole map: one that grows by doubling holds twice as much meanwhile.
void make_room(const MapChange& change, OccupancyMap& map) {
  std::size_t occupied = 0, passed = 0;
  change.for_each_part([&](const MapBlocks& blocks) {
    occupied += blocks.occupied.size();
    passed += blocks.passed.size();
  });
  map.occupied.reserve(occupied);
  map.passed.reserve(passed);
}

std::vector<voxel_block_t> to_messages(const VoxelMap& map) {
  std::vector<voxel_block_t> messages;
  messages.reserve(map.block_count());
  for (std::size_t i = 0; i < map.block_count(); ++i)
    if (map.block(i) != VoxelBlock{})
      messages.push_back(to_message(map.block_position(i), map.block(i)));
  return messages;
}

std::vector<voxel_block_t> to_messages(const VoxelMap& map, const std::vector<Voxel>& positions) {
  std::vector<voxel_block_t> messages;
  messages.reserve(positions.size());
  for (const Voxel& position : positions) {
    const VoxelBlock* block = map.find_block(position);
    messages.push_back(to_message(position, block ? *block : VoxelBlock{}));
  }
  return messages;
}

// Appends what changed.
void set_blocks(const std::vector<voxel_block_t>& blocks, VoxelMap& map,
                std::vector<Voxel>& changed) {
  for (const voxel_block_t& message : blocks) {
    const Voxel position{message.x, message.y, message.z};
    if (map.set_block(position, bits_of(message))) changed.push_back(position);
  }
}

}  // namespace

MapResolution resolution_of(const OccupancyMap& map) {
  return {map.occupied.resolution_m(), map.passed.resolution_m()};
}

MapBlocks to_messages(const OccupancyMap& map) {
  return {to_messages(map.occupied), to_messages(map.passed)};
}

MapBlocks to_messages(const OccupancyMap& map, const ChangedBlocks& positions) {
  return {to_messages(map.occupied, positions.occupied), to_messages(map.passed, positions.passed)};
}

AppliedChange apply(const MapChange& change, OccupancyMap& map) {
  AppliedChange applied{.replaced = change.is_whole(), .changed = {}};
  applied.changed.from = map.revision();
  if (applied.replaced) {
    map = {VoxelMap(change.resolution.occupied_m), VoxelMap(change.resolution.passed_m)};
    make_room(change, map);
  }
  VOXLIST_CHECK(resolution_of(map) == change.resolution, "the change is of another map");
  change.for_each_part([&](const MapBlocks& blocks) {
    set_blocks(blocks.occupied, map.occupied, applied.changed.occupied);
    set_blocks(blocks.passed, map.passed, applied.changed.passed);
    if (applied.replaced) applied.changed = {{}, {}, applied.changed.from, {}};
  });
  applied.changed.to = map.revision();
  return applied;
}

}  // namespace voxlist::bus
