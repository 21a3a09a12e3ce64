#include "matching/window_map.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace voxlist {
namespace {

// A margin all round: blocks near the edge mark cells beyond it.
constexpr std::int32_t kMargin = 16;
// Edge of the patches whose occupied cells are counted.
constexpr std::int32_t kPatch = 32;
// Layers below and above, for a map that grows.
constexpr std::int32_t kSpareLayers = 2;

CellRectangle whole_patches(const CellRectangle& r) {
  const auto down = [](std::int32_t v) { return floor_div(v, kPatch) * kPatch; };
  const auto up = [&](std::int32_t v) { return down(v + kPatch - 1); };
  return {down(r.low_x), down(r.low_y), up(r.end_x), up(r.end_y)};
}

// What a block occupies, from the column before it to the one behind (a byte each) and from the row
// before it to the one behind (bits 0 to 3 of each byte).
std::uint32_t occupied_cells(const VoxelBlock& bits) {
  std::uint64_t plan = 0;
  for (const std::uint64_t word : bits) plan |= word;
  constexpr std::uint64_t kQuarter = 0x0f0f0f0f;
  std::uint32_t cells = 0;
  if (plan & kQuarter) cells |= 0x00020702;
  if (plan & kQuarter << 4) cells |= 0x02070200;
  if (plan & kQuarter << 32) cells |= 0x00040e04;
  if (plan & kQuarter << 36) cells |= 0x040e0400;
  return cells;
}

}  // namespace

WindowMap::WindowMap(const VoxelMap& map, const CellRectangle& ground)
    : ground_(whole_patches(ground)),
      low_x_(ground_.low_x - kMargin),
      low_y_(ground_.low_y - kMargin),
      size_x_(ground_.end_x + kMargin - low_x_),
      size_y_(ground_.end_y + kMargin - low_y_) {
  std::vector<std::size_t> within;
  std::int32_t highest = std::numeric_limits<std::int32_t>::min(),
               lowest = std::numeric_limits<std::int32_t>::max();
  for (std::size_t i = 0; i < map.block_count(); ++i) {
    const Voxel& block = map.block_position(i);
    if (!on_ground(block)) continue;
    within.push_back(i);
    lowest = std::min(lowest, block.z);
    highest = std::max(highest, block.z);
  }
  if (within.empty()) return;
  lowest_z_ = lowest - kSpareLayers;
  size_z_ = highest + kSpareLayers + 1 - lowest_z_;
  columns_.resize(static_cast<std::size_t>(size_x_) * static_cast<std::size_t>(size_y_) *
                      static_cast<std::size_t>(size_z_) +
                  kTile);
  occupied_.resize(patch_of(ground_.low_x, ground_.low_y, lowest_z_ + size_z_));
  for (const std::size_t i : within) mark(map.block_position(i), map.block(i));
}

bool WindowMap::add(const VoxelMap& map, const std::vector<Voxel>& blocks) {
  for (const Voxel& position : blocks) {
    const VoxelBlock* block = map.find_block(position);
    if (!block || !on_ground(position)) continue;
    if (position.z < lowest_z_ || position.z >= lowest_z_ + size_z_) return false;
    mark(position, *block);
  }
  return true;
}

WindowMap::Count WindowMap::count(const CellRectangle& rectangle) const {
  const CellRectangle r = whole_patches(rectangle);
  std::int64_t occupied = 0;
  std::int32_t lowest = 0, end = 0;
  for (std::int32_t z = lowest_z_; z < lowest_z_ + size_z_; ++z) {
    std::int64_t in_layer = 0;
    for (std::int32_t y = r.low_y; y < r.end_y; y += kPatch)
      for (std::int32_t x = r.low_x; x < r.end_x; x += kPatch)
        in_layer += occupied_[patch_of(x, y, z)];
    if (in_layer == 0) continue;
    if (occupied == 0) lowest = z;
    end = z + 1;
    occupied += in_layer;
  }
  return {std::int64_t{end - lowest} * (r.end_x - r.low_x) * (r.end_y - r.low_y), occupied};
}

// Whether a block may occupy cells of the ground, or of the margin at least.
bool WindowMap::on_ground(const Voxel& block) const {
  const std::int32_t x = 2 * block.x - low_x_, y = 2 * block.y - low_y_;
  return x >= kTile && x + kTile <= size_x_ && y >= kTile && y + kTile <= size_y_;
}

void WindowMap::mark(const Voxel& block, const VoxelBlock& bits) {
  const std::uint32_t cells = occupied_cells(bits);
  constexpr std::uint32_t kColumns = 0x01010101;
  const std::int32_t x = 2 * block.x - 1, y = 2 * block.y - 1;
  std::uint8_t* row = columns_.data() + place(x, y, block.z);
  // Rows that begin on the block's first row or behind it, with the cells that are new there.
  for (int d = 0; d < 4; ++d) {
    std::uint32_t held;
    std::memcpy(&held, row + d * std::int64_t{size_x_}, sizeof held);
    const std::uint32_t wanted = cells >> d & (0x0fU >> d) * kColumns;
    for (std::uint32_t news = wanted & ~held & kColumns; news != 0; news &= news - 1) {
      const std::int32_t i = std::countr_zero(news) / 8;
      if (x + i >= ground_.low_x && x + i < ground_.end_x && y + d >= ground_.low_y &&
          y + d < ground_.end_y)
        ++occupied_[patch_of(x + i, y + d, block.z)];
    }
    held |= wanted;
    std::memcpy(row + d * std::int64_t{size_x_}, &held, sizeof held);
  }
  // Rows before it that see it.
  for (int d = 1; d < kTile; ++d) {
    row -= size_x_;
    std::uint32_t held;
    std::memcpy(&held, row, sizeof held);
    held |= (cells & (0xffU >> d) * kColumns) << d;
    std::memcpy(row, &held, sizeof held);
  }
}

std::size_t WindowMap::patch_of(std::int32_t x, std::int32_t y, std::int32_t z) const {
  const auto along = [](std::int32_t length) { return static_cast<std::size_t>(length / kPatch); };
  const std::size_t per_row = along(ground_.end_x - ground_.low_x),
                    rows = along(ground_.end_y - ground_.low_y);
  return (static_cast<std::size_t>(z - lowest_z_) * rows + along(y - ground_.low_y)) * per_row +
         along(x - ground_.low_x);
}

}  // namespace voxlist
