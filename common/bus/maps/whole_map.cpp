#include "voxlist/bus/maps/whole_map.h"

#include <algorithm>
#include <span>
#include <tuple>
#include <utility>

#include "voxlist/bus/maps/map_convert.h"

namespace voxlist::bus {
namespace {

constexpr std::size_t kBlockBytes = 3 * sizeof(std::int32_t) + 8 * sizeof(std::int64_t);

// The blocks with voxels, in the order of split_map().
std::vector<Voxel> positions_of(const VoxelMap& map) {
  std::vector<Voxel> positions;
  for (std::size_t i = 0; i < map.block_count(); ++i)
    if (map.block(i) != VoxelBlock{}) positions.push_back(map.block_position(i));
  std::ranges::sort(positions, {}, [](const Voxel& at) { return std::tuple(at.z, at.y, at.x); });
  return positions;
}

// Takes up to so many off the front.
std::vector<Voxel> take(std::span<const Voxel>& positions, std::size_t count) {
  const auto some = positions.first(std::min(count, positions.size()));
  positions = positions.subspan(some.size());
  return {some.begin(), some.end()};
}

}  // namespace

WholeMap::WholeMap(MapChange word, const OccupancyMap& map) {
  word.base_version = kWholeMap;
  header_ = std::move(split_map(std::move(word)).front());
  const std::vector<Voxel> occupied = positions_of(map.occupied), passed = positions_of(map.passed);
  std::span<const Voxel> left = occupied, left_passed = passed;
  while (!left.empty() || !left_passed.empty()) {
    ChangedBlocks some;
    some.occupied = bus::take(left, kBlocksPerChunk);
    some.passed = bus::take(left_passed, kBlocksPerChunk - some.occupied.size());
    chunks_.emplace_back(to_messages(map, some));
  }
  check_chunks(chunks_.size());
  if (chunks_.empty()) chunks_.emplace_back(MapBlocks{});
  header_.n_chunks = static_cast<std::int32_t>(chunks_.size());
}

std::size_t WholeMap::bytes(std::size_t chunk) const {
  return static_cast<std::size_t>(header_.getEncodedSize()) + kBlockBytes * chunks_[chunk]->size();
}

map_update_t WholeMap::take(std::size_t chunk) {
  map_update_t message = header_;
  MapBlocks blocks = chunks_[chunk]->unpacked();
  chunks_[chunk].reset();
  message.chunk = static_cast<std::int32_t>(chunk);
  message.n_blocks = static_cast<std::int32_t>(blocks.occupied.size());
  message.n_passed_blocks = static_cast<std::int32_t>(blocks.passed.size());
  message.blocks = std::move(blocks.occupied);
  message.passed_blocks = std::move(blocks.passed);
  return message;
}

}  // namespace voxlist::bus
