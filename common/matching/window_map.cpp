#include "matching/window_map.h"

#include <algorithm>
#include <limits>

namespace voxlist {
namespace {

constexpr std::int32_t kMargin = 4;

}  // namespace

// A margin all round: blocks at the edge mark cells beyond it.
WindowMap::WindowMap(const VoxelMap& map, const CellRectangle& ground)
    : ground_(ground),
      low_x_(ground.low_x - kMargin),
      low_y_(ground.low_y - kMargin),
      size_x_(ground.end_x + kMargin - low_x_),
      size_y_(ground.end_y + kMargin - low_y_) {
  std::vector<std::size_t> within;
  std::int32_t highest = std::numeric_limits<std::int32_t>::min(),
               lowest = std::numeric_limits<std::int32_t>::max();
  for (std::size_t i = 0; i < map.block_count(); ++i) {
    const Voxel& b = map.block_position(i);
    const std::int32_t x = 2 * b.x - low_x_, y = 2 * b.y - low_y_;
    if (x < 1 || x + 2 >= size_x_ || y < 1 || y + 2 >= size_y_) continue;
    within.push_back(i);
    lowest = std::min(lowest, b.z);
    highest = std::max(highest, b.z);
  }
  if (!within.empty()) {
    lowest_z_ = lowest;
    size_z_ = highest - lowest + 1;
  }
  columns_.assign(static_cast<std::size_t>(cells()) + kTile, 0);
  for (const std::size_t i : within) mark(map.block_position(i), map.block(i));
  occupied_cells_ = std::count(columns_.begin(), columns_.end(), 1);
  for (std::int32_t z = 0; z < size_z_; ++z) {
    for (std::int32_t y = size_y_ - 2; y >= 0; --y) {
      std::uint8_t* row = columns_.data() + (std::int64_t{z} * size_y_ + y) * size_x_;
      for (std::int32_t x = 0; x < size_x_; ++x)
        row[x] = static_cast<std::uint8_t>(row[x] | row[x + size_x_] << 1);
    }
  }
}

void WindowMap::mark(const Voxel& block, const VoxelBlock& bits) {
  std::uint64_t plan = 0;
  for (const std::uint64_t word : bits) plan |= word;
  constexpr std::uint64_t kLowX = 0x0f0f0f0f, kHighX = 0xf0f0f0f0;
  const std::uint64_t quarters[2][2] = {{plan & kLowX, plan & kHighX},
                                        {plan >> 32 & kLowX, plan >> 32 & kHighX}};
  for (std::int32_t y = 0; y < 2; ++y) {
    for (std::int32_t x = 0; x < 2; ++x) {
      if (quarters[y][x] == 0) continue;
      std::uint8_t* cell = columns_.data() + place(2 * block.x + x, 2 * block.y + y, block.z);
      cell[0] = cell[-1] = cell[1] = cell[-size_x_] = cell[size_x_] = 1;
    }
  }
}

}  // namespace voxlist
