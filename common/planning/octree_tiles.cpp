#include "voxlist/planning/octree_tiles.h"

#include <algorithm>

namespace voxlist::planning {
namespace {

constexpr std::int32_t kBlocks = kReach / kBlockEdge;  // from the middle to an end

std::uint32_t spread(std::uint32_t value) {
  std::uint32_t out = 0;
  for (int i = 0; i < 10; ++i) out |= (value >> i & 1) << 3 * i;
  return out;
}

std::uint32_t morton(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  return spread(x) | spread(y) << 1 | spread(z) << 2;
}

}  // namespace

void OctreeTiles::update(const CounterMap& map, std::span<const std::uint32_t> changed) {
  for (const std::uint32_t number : changed) add(map.block_position(number), number);
}

void OctreeTiles::add(const Voxel& block, std::uint32_t number) {
  const std::uint32_t at[3] = {static_cast<std::uint32_t>(block.x + kBlocks),
                               static_cast<std::uint32_t>(block.y + kBlocks),
                               static_cast<std::uint32_t>(block.z + kBlocks)};
  if (std::max({at[0], at[1], at[2]}) >= 2 * kBlocks) return;
  Tile& tile = tiles_[morton(at[0] / 8, at[1] / 8, at[2] / 8)];
  tile.is_encoded = false;
  const std::pair entry{morton(at[0] % 8, at[1] % 8, at[2] % 8), number};
  const auto place = std::lower_bound(tile.blocks.begin(), tile.blocks.end(), entry);
  if (place == tile.blocks.end() || *place != entry) tile.blocks.insert(place, entry);
}

}  // namespace voxlist::planning
