#include "voxlist/matching/counting/window_map.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <new>

#include "voxlist/system/check.h"

namespace voxlist::matching {
namespace {

// Cells round the ground that can be written: a block marks one cell beyond itself on each side,
// and the seven rows before that see it.
constexpr std::int32_t kMargin = 16;
// Edge (cells) of the patches that are made ready, and whose occupied cells are counted, at once:
// 2.56 m at 0.08 m, about what a robot comes to see anew from scan to scan. It changes speed, and
// what a significance's volume is rounded to.
constexpr std::int32_t kPatch = 32;
// Cells of room beyond what is asked for, on each side: 20 m at 0.08 m, so that it serves while the
// robot moves on. More costs address space; less makes the whole window ready more often.
constexpr std::int32_t kMore = 8 * kPatch;
// Layers below and above the map's, so that a map that grows a little keeps its room.
constexpr std::int32_t kSpareLayers = 2;

CellRectangle whole_patches(const CellRectangle& r) {
  const auto down = [](std::int32_t v) { return floor_div(v, kPatch) * kPatch; };
  const auto up = [&](std::int32_t v) { return down(v + kPatch - 1); };
  return {down(r.low_x), down(r.low_y), up(r.end_x), up(r.end_y)};
}

CellRectangle widened(const CellRectangle& r, std::int32_t by) {
  return {r.low_x - by, r.low_y - by, r.end_x + by, r.end_y + by};
}

// The position of the patch that holds a cell.
Voxel patch_of(std::int32_t x, std::int32_t y) {
  return {floor_div(x, kPatch), floor_div(y, kPatch), 0};
}

// The cells that a block marks: a byte for each column from the one before it to the one behind,
// bits 0 to 3 of it for the rows from the one before it to the one behind.
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

// A map's blocks stand in a row, by their numbers. Precondition: the map has the block.
std::uint32_t number_of(const VoxelMap& map, const Voxel& block) {
  return static_cast<std::uint32_t>(map.find_block(block) - &map.block(0));
}

}  // namespace

void WindowMap::hold(const CellRectangle& needed) {
  VOXLIST_CHECK(map_.revision() == revision_,
                "the map has changed and map_changed() was not called");
  list_new_blocks();
  // Blocks near by mark cells of a patch too.
  const CellRectangle around = whole_patches(widened(needed, kPatch));
  if (!columns_ || !ground_.holds(around)) make_room(widened(around, kMore));
  for (std::int32_t y = around.low_y; y < around.end_y; y += kPatch) {
    for (std::int32_t x = around.low_x; x < around.end_x; x += kPatch) {
      Patch* patch = find_patch(x, y);
      if (!patch || patch->ready) continue;
      for (const std::uint32_t i : patch->blocks) mark(i);
      patch->ready = true;
    }
  }
}

void WindowMap::map_changed(const std::vector<Voxel>& blocks) {
  revision_ = map_.revision();
  list_new_blocks();
  if (!columns_) return;
  for (const Voxel& position : blocks)
    if (is_ready(position)) update(number_of(map_, position));
}

// Most blocks that change mark the cells that they did, and most others more of them.
void WindowMap::update(std::uint32_t number) {
  const std::uint32_t before = marked_[number], now = occupied_cells(map_.block(number));
  if (now == before) return;
  if ((before & ~now) == 0) return mark(number);
  marked_[number] = now;
  mark_again(map_.block_position(number));
}

WindowMap::Count WindowMap::count(const CellRectangle& rectangle) const {
  const CellRectangle r = whole_patches(rectangle);
  std::int64_t occupied = 0;
  std::int32_t lowest = 0, end = 0;
  for (std::int32_t z = lowest_z_; z < lowest_z_ + size_z_; ++z) {
    std::int64_t in_layer = 0;
    for (std::int32_t y = r.low_y; y < r.end_y; y += kPatch)
      for (std::int32_t x = r.low_x; x < r.end_x; x += kPatch)
        in_layer += occupied_[counter_of(x, y, z)];
    if (in_layer == 0) continue;
    if (occupied == 0) lowest = z;
    end = z + 1;
    occupied += in_layer;
  }
  return {std::int64_t{end - lowest} * (r.end_x - r.low_x) * (r.end_y - r.low_y), occupied};
}

WindowMap::Patch* WindowMap::find_patch(std::int32_t x, std::int32_t y) {
  const std::uint32_t number = patch_positions_.find(patch_of(x, y));
  return number == Numbering<Voxel>::kNone ? nullptr : &patches_[number];
}

// A map numbers its blocks as they come.
void WindowMap::list_new_blocks() {
  for (; listed_ < map_.block_count(); ++listed_) {
    const Voxel& block = map_.block_position(listed_);
    const std::int32_t x = 2 * block.x, y = 2 * block.y;
    const std::uint32_t number = patch_positions_.number(patch_of(x, y));
    if (number == patches_.size()) patches_.push_back({{}, layer_of(block), layer_of(block)});
    Patch& patch = patches_[number];
    patch.lowest_z = std::min(patch.lowest_z, layer_of(block));
    patch.highest_z = std::max(patch.highest_z, layer_of(block));
    patch.blocks.push_back(static_cast<std::uint32_t>(listed_));
    marked_.push_back(0);
    const bool room_enough = layer_of(block) >= lowest_z_ && layer_of(block) < lowest_z_ + size_z_;
    if (!room_enough && ground_.holds({x, y, x + 1, y + 1})) columns_.reset();
  }
}

void WindowMap::make_room(const CellRectangle& ground) {
  ground_ = ground;
  low_x_ = ground.low_x - kMargin;
  low_y_ = ground.low_y - kMargin;
  size_x_ = ground.end_x + kMargin - low_x_;
  size_y_ = ground.end_y + kMargin - low_y_;
  std::int32_t highest = std::numeric_limits<std::int32_t>::min(),
               lowest = std::numeric_limits<std::int32_t>::max();
  for (Patch& patch : patches_) {
    patch.ready = false;
    const Voxel& block = map_.block_position(patch.blocks.front());
    if (!ground.holds({2 * block.x, 2 * block.y, 2 * block.x + 1, 2 * block.y + 1})) continue;
    lowest = std::min(lowest, patch.lowest_z);
    highest = std::max(highest, patch.highest_z);
  }
  const bool empty = highest < lowest;
  lowest_z_ = empty ? 0 : lowest - kSpareLayers;
  size_z_ = empty ? 0 : highest + kSpareLayers + 1 - lowest_z_;
  // Memory that calloc gives costs nothing until it is touched.
  const auto bytes = static_cast<std::size_t>(size_x_) * static_cast<std::size_t>(size_y_) *
                     static_cast<std::size_t>(size_z_);
  columns_.reset(static_cast<std::uint8_t*>(std::calloc(bytes + 1, 1)));
  if (!columns_) throw std::bad_alloc();
  occupied_.assign(counter_of(ground.low_x, ground.low_y, lowest_z_ + size_z_), 0);
}

void WindowMap::mark(std::uint32_t number) {
  const Voxel& block = map_.block_position(number);
  const std::uint32_t cells = marked_[number] = occupied_cells(map_.block(number));
  constexpr std::uint32_t kColumns = 0x01010101;
  const std::int32_t x = 2 * block.x - 1, y = 2 * block.y - 1, z = layer_of(block);
  std::uint8_t* row = columns_.get() + place(x, y, z);
  // Rows that begin on the block's first row or behind it, with the cells that are new there.
  for (int d = 0; d < 4; ++d) {
    std::uint32_t held;
    std::memcpy(&held, row + d * std::int64_t{size_x_}, sizeof held);
    const std::uint32_t wanted = cells >> d & (0x0fU >> d) * kColumns;
    for (std::uint32_t news = wanted & ~held & kColumns; news != 0; news &= news - 1) {
      const std::int32_t i = std::countr_zero(news) / 8;
      if (x + i >= ground_.low_x && x + i < ground_.end_x && y + d >= ground_.low_y &&
          y + d < ground_.end_y)
        ++occupied_[counter_of(x + i, y + d, z)];
    }
    held |= wanted;
    std::memcpy(row + d * std::int64_t{size_x_}, &held, sizeof held);
  }
  // The rows before it see its cells, too.
  for (int d = 1; d < kTile; ++d) {
    row -= size_x_;
    std::uint32_t held;
    std::memcpy(&held, row, sizeof held);
    held |= (cells & (0xffU >> d) * kColumns) << d;
    std::memcpy(row, &held, sizeof held);
  }
}

bool WindowMap::is_ready(const Voxel& block) {
  const Patch* patch = find_patch(2 * block.x, 2 * block.y);
  return patch && patch->ready;
}

// What the blocks of a neighbouring column mark of a block's cells, in its layer.
std::uint32_t WindowMap::cells_at(const Voxel& block, std::int32_t dx, std::int32_t dy) {
  Voxel at{block.x + dx, block.y + dy, layer_of(block) << doublings_};
  if (!is_ready(at)) return 0;
  std::uint32_t cells = 0;
  for (const std::int32_t end = at.z + (1 << doublings_); at.z < end; ++at.z)
    if (const VoxelBlock* bits = map_.find_block(at)) cells |= occupied_cells(*bits);
  if (dx != 0) cells = dx > 0 ? cells << 16 : cells >> 16;
  if (dy != 0) cells = dy > 0 ? cells << 2 & 0x0c0c0c0c : cells >> 2 & 0x03030303;
  return cells;
}

// A block that has lost voxels may leave cells that its neighbours mark as well.
void WindowMap::mark_again(const Voxel& block) {
  std::uint32_t cells = 0;
  for (std::int32_t dy = -1; dy <= 1; ++dy)
    for (std::int32_t dx = -1; dx <= 1; ++dx) cells |= cells_at(block, dx, dy);
  const std::int32_t x = 2 * block.x - 1, y = 2 * block.y - 1, z = layer_of(block);
  for (std::int32_t i = 0; i < 4; ++i)
    for (std::int32_t d = 0; d < 4; ++d) set_cell(x + i, y + d, z, (cells >> (8 * i + d) & 1) != 0);
}

void WindowMap::set_cell(std::int32_t x, std::int32_t y, std::int32_t z, bool is_occupied) {
  std::uint8_t* row = columns_.get() + place(x, y, z);
  if (((*row & 1) != 0) == is_occupied) return;
  if (x >= ground_.low_x && x < ground_.end_x && y >= ground_.low_y && y < ground_.end_y)
    occupied_[counter_of(x, y, z)] += is_occupied ? 1 : -1;
  for (int k = 0; k < kTile; ++k, row -= size_x_) *row = static_cast<std::uint8_t>(*row ^ 1U << k);
}

std::size_t WindowMap::counter_of(std::int32_t x, std::int32_t y, std::int32_t z) const {
  const auto along = [](std::int32_t length) { return static_cast<std::size_t>(length / kPatch); };
  const std::size_t per_row = along(ground_.end_x - ground_.low_x),
                    rows = along(ground_.end_y - ground_.low_y);
  return (static_cast<std::size_t>(z - lowest_z_) * rows + along(y - ground_.low_y)) * per_row +
         along(x - ground_.low_x);
}

}  // namespace voxlist::matching
