#include "voxlist/bus/maps/map_chunks.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <tuple>

namespace voxlist::bus {
namespace {

void put_in_order(std::vector<voxel_block_t>& blocks) {
  const auto order = [](const voxel_block_t& b) { return std::tie(b.z, b.y, b.x); };
  std::ranges::sort(blocks, [&](const auto& a, const auto& b) { return order(a) < order(b); });
}

// The blocks from `begin` on and before `end`, as far as there are any.
std::vector<voxel_block_t> slice(const std::vector<voxel_block_t>& blocks, std::ptrdiff_t begin,
                                 std::ptrdiff_t end) {
  const auto at = [&](std::ptrdiff_t i) {
    return blocks.begin() + std::clamp<std::ptrdiff_t>(i, 0, std::ssize(blocks));
  };
  return {at(begin), at(end)};
}

}  // namespace

void check_chunks(std::size_t chunks) {
  if (chunks > std::size_t{kMaxChunks})
    throw std::length_error("map of more than 12 million blocks");
}

std::vector<map_update_t> split_map(MapChange change) {
  auto& [occupied, passed] = change.blocks;
  put_in_order(occupied);
  put_in_order(passed);
  const std::ptrdiff_t n_occupied = std::ssize(occupied);
  const std::ptrdiff_t n_blocks = n_occupied + std::ssize(passed);
  const auto n_chunks =
      std::max<std::ptrdiff_t>(1, (n_blocks + kBlocksPerChunk - 1) / kBlocksPerChunk);
  check_chunks(static_cast<std::size_t>(n_chunks));

  std::vector<map_update_t> messages;
  for (std::ptrdiff_t chunk = 0; chunk < n_chunks; ++chunk) {
    const std::ptrdiff_t begin = chunk * kBlocksPerChunk, end = begin + kBlocksPerChunk;
    map_update_t& message = messages.emplace_back();
    message.utime = change.utime_us;
    message.map_id = change.map_id;
    message.version = change.version;
    message.base_version = change.base_version;
    message.chunk = static_cast<std::int32_t>(chunk);
    message.n_chunks = static_cast<std::int32_t>(n_chunks);
    message.moves = change.moves;
    message.edits = change.edits;
    const Pose2& moved = change.T_new_old;
    std::ranges::copy(std::array{moved.x_m, moved.y_m, moved.yaw_rad}, message.moved);
    message.resolution_m = change.resolution.occupied_m;
    message.passed_resolution_m = change.resolution.passed_m;
    message.blocks = slice(occupied, begin, end);
    message.n_blocks = static_cast<std::int32_t>(message.blocks.size());
    message.passed_blocks = slice(passed, begin - n_occupied, end - n_occupied);
    message.n_passed_blocks = static_cast<std::int32_t>(message.passed_blocks.size());
  }
  return messages;
}

}  // namespace voxlist::bus
