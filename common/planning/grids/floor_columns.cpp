#include "voxlist/planning/grids/floor_columns.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "voxlist/planning/grids/tile_maker.h"

namespace voxlist::planning {
namespace {

constexpr std::int32_t kTileShift = 3;
static_assert(1 << kTileShift == kTileEdge);

// Blocks of voxels along a tile's edge.
constexpr std::int32_t kVoxelBlocks = kTileEdge * kLayersInCell / kBlockEdge;

// A surface on either side belongs to the same floor where it is no farther above or below (m).
constexpr float kSameFloor_m = 0.3F;

// Surfaces that differ by less are level: what noise leaves of a column's mean (m).
constexpr float kLevel_m = 0.01F;

// Tiles in the bounds of which a table of places is kept: 16 MB. Beyond that they are looked up.
constexpr std::size_t kMostPlaces = std::size_t{1} << 22;

constexpr std::array<std::array<Cell, 2>, 4> kOpposite = {
    {{{{-1, 0}, {1, 0}}}, {{{0, -1}, {0, 1}}}, {{{-1, -1}, {1, 1}}}, {{{-1, 1}, {1, -1}}}}};

void insert(std::vector<std::int32_t>& ascending, std::int32_t value) {
  const auto at = std::ranges::lower_bound(ascending, value);
  if (at == ascending.end() || *at != value) ascending.insert(at, value);
}

void sort_once(std::vector<std::uint32_t>& numbers) {
  std::ranges::sort(numbers);
  numbers.erase(std::ranges::unique(numbers).begin(), numbers.end());
}

// The surface next to a height, on the same floor.
std::optional<float> surface_near(const Column& column, float height_m) {
  std::optional<float> found;
  float nearest_m = kSameFloor_m;
  for (const Span& span : column.spans) {
    const float away_m = std::abs(span.surface_m - height_m);
    if (away_m >= nearest_m) continue;
    nearest_m = away_m;
    found = span.surface_m;
  }
  return found;
}

}  // namespace

std::uint32_t FloorColumns::tile_of_voxels(const Voxel& block) {
  const std::uint32_t tile =
      add_tile({floor_div(block.x, kVoxelBlocks), floor_div(block.y, kVoxelBlocks), 0});
  insert(heights_[tile].voxels, block.z);
  return tile;
}

std::uint32_t FloorColumns::tile_of_free(const Voxel& block) {
  const std::uint32_t tile = add_tile({block.x, block.y, 0});
  insert(heights_[tile].free, block.z);
  return tile;
}

std::uint32_t FloorColumns::add_tile(const Voxel& position) {
  const std::uint32_t tile = positions_.number(position);
  if (tile < tiles_.size()) return tile;
  tiles_.emplace_back();
  heights_.emplace_back();
  grow(position);
  return tile;
}

void FloorColumns::grow(const Voxel& tile) {
  const Cell low{tile.x * kTileEdge, tile.y * kTileEdge};
  const Cell high{low.x + kTileEdge, low.y + kTileEdge};
  if (!bounds_) {
    bounds_ = {low, high};
    return;
  }
  bounds_->low = {std::min(bounds_->low.x, low.x), std::min(bounds_->low.y, low.y)};
  bounds_->high = {std::max(bounds_->high.x, high.x), std::max(bounds_->high.y, high.y)};
}

std::size_t FloorColumns::place_of(const Voxel& tile) const {
  const auto x = static_cast<std::size_t>(tile.x - bounds_->low.x / kTileEdge);
  const auto y = static_cast<std::size_t>(tile.y - bounds_->low.y / kTileEdge);
  return y * static_cast<std::size_t>(bounds_->width() / kTileEdge) + x;
}

void FloorColumns::place_tiles() {
  if (placed_ == positions_.size()) return;
  placed_ = positions_.size();
  places_.clear();
  const std::size_t most = bounds_->size() / (kTileEdge * kTileEdge);
  if (most > kMostPlaces) return;
  places_.resize(most);
  for (std::uint32_t i = 0; i < placed_; ++i) places_[place_of(positions_.key(i))] = i + 1;
}

void FloorColumns::take(const OccupancyMap& map, const OccupancyMap& free_space) {
  *this = {};
  for (std::size_t i = 0; i < map.occupied.block_count(); ++i)
    tile_of_voxels(map.occupied.block_position(i));
  for (const VoxelMap* cells : {&free_space.occupied, &free_space.passed})
    for (std::size_t i = 0; i < cells->block_count(); ++i) tile_of_free(cells->block_position(i));
  std::vector<std::uint32_t> all(tiles_.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::uint32_t>(i);
  remake(all, map, free_space);
}

std::vector<TileChange> FloorColumns::follow(const OccupancyMap& map, const ChangedBlocks& changed,
                                             const OccupancyMap& free_space,
                                             const ChangedBlocks& changed_free) {
  std::vector<std::uint32_t> tiles;
  for (const Voxel& block : changed.occupied) tiles.push_back(tile_of_voxels(block));
  for (const auto* blocks : {&changed_free.occupied, &changed_free.passed})
    for (const Voxel& block : *blocks) tiles.push_back(tile_of_free(block));
  sort_once(tiles);
  return remake(tiles, map, free_space);
}

namespace {

ColumnTile make_tile(const Voxel& at, const std::vector<std::int32_t>& voxel_heights,
                     const std::vector<std::int32_t>& free_heights, const OccupancyMap& map,
                     const OccupancyMap& free_space) {
  TileMaker maker;
  for (const std::int32_t z : voxel_heights)
    for (std::int32_t i = 0; i < kVoxelBlocks * kVoxelBlocks; ++i) {
      const std::int32_t x = i % kVoxelBlocks, y = i / kVoxelBlocks;
      const Voxel block{at.x * kVoxelBlocks + x, at.y * kVoxelBlocks + y, z};
      if (const VoxelBlock* bits = map.occupied.find_block(block)) maker.add_voxels(x, y, z, *bits);
    }
  for (const std::int32_t z : free_heights) {
    if (const VoxelBlock* bits = free_space.passed.find_block({at.x, at.y, z}))
      maker.add_free(z, *bits);
    if (const VoxelBlock* bits = free_space.occupied.find_block({at.x, at.y, z}))
      maker.add_blocked(z, *bits);
  }
  return maker.made();
}

}  // namespace

std::vector<TileChange> FloorColumns::remake(const std::vector<std::uint32_t>& tiles,
                                             const OccupancyMap& map,
                                             const OccupancyMap& free_space) {
  place_tiles();
  std::vector<ColumnTile> before;
  for (const std::uint32_t tile : tiles)
    before.push_back(
        std::exchange(tiles_[tile], make_tile(positions_.key(tile), heights_[tile].voxels,
                                              heights_[tile].free, map, free_space)));
  std::vector<std::uint32_t> near;
  for (const std::uint32_t tile : tiles)
    for (std::int32_t i = 0; i < 9; ++i) {
      const Voxel& at = positions_.key(tile);
      const std::uint32_t found = positions_.find({at.x + i % 3 - 1, at.y + i / 3 - 1, 0});
      if (found != Numbering<Voxel>::kNone) near.push_back(found);
    }
  sort_once(near);
  std::vector<TileChange> changes;
  std::size_t made = 0;  // both lists ascend
  for (const std::uint32_t tile : near) {
    const Voxel& at = positions_.key(tile);
    std::uint64_t columns = note_kinks(at);
    if (made < tiles.size() && tiles[made] == tile)
      columns = tiles_[tile].differs_from(before[made++]);
    if (columns != 0) changes.push_back({{at.x * kTileEdge, at.y * kTileEdge}, columns});
  }
  return changes;
}

// The columns of which a span's kink has changed.
std::uint64_t FloorColumns::note_kinks(const Voxel& tile) {
  ColumnTile& columns = tiles_[positions_.find(tile)];
  std::uint64_t changed = 0;
  for (std::int32_t y = 0; y < kTileEdge; ++y)
    for (std::int32_t x = 0; x < kTileEdge; ++x)
      for (Span& span : columns.spans_at(x, y)) {
        const Cell cell{tile.x * kTileEdge + x, tile.y * kTileEdge + y};
        const float kink_m = kink_of(cell, span.surface_m);
        if (std::exchange(span.kink_m, kink_m) != kink_m)
          changed |= std::uint64_t{1} << (x + kTileEdge * y);
      }
  return changed;
}

float FloorColumns::kink_of(const Cell& cell, float surface_m) const {
  float largest_m = 0.0F;
  for (const auto& [a, b] : kOpposite) {
    const auto one = surface_near(at({cell.x + a.x, cell.y + a.y}), surface_m);
    const auto other = surface_near(at({cell.x + b.x, cell.y + b.y}), surface_m);
    if (!one || !other) continue;
    const float nearer_m = std::min(std::abs(*one - surface_m), std::abs(*other - surface_m));
    if (nearer_m > kLevel_m) largest_m = std::max(largest_m, std::abs(*one - *other));
  }
  return largest_m;
}

Column FloorColumns::at(const Cell& cell) const {
  if (!bounds_ || !bounds_->contains(cell)) return {};
  const Voxel position{cell.x >> kTileShift, cell.y >> kTileShift, 0};
  const std::uint32_t tile =
      places_.empty() ? positions_.find(position) : places_[place_of(position)] - 1;
  if (tile == Numbering<Voxel>::kNone) return {};
  return tiles_[tile].at(cell.x & (kTileEdge - 1), cell.y & (kTileEdge - 1));
}

std::size_t FloorColumns::memory_bytes() const {
  std::size_t bytes = positions_.memory_bytes() + places_.capacity() * sizeof(std::uint32_t) +
                      heights_.capacity() * sizeof(Heights);
  for (const ColumnTile& tile : tiles_) bytes += tile.memory_bytes();
  for (const Heights& heights : heights_)
    bytes += (heights.voxels.capacity() + heights.free.capacity()) * sizeof(std::int32_t);
  return bytes;
}

}  // namespace voxlist::planning
