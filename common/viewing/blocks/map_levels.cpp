#include "voxlist/viewing/blocks/map_levels.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "voxlist/bus/maps/map_convert.h"
#include "voxlist/viewing/blocks/resampled_block.h"

namespace voxlist::viewing {

std::optional<std::uint32_t> MapLevel::put(const Voxel& position, const VoxelBlock& bits,
                                           std::uint32_t now_s) {
  const bool is_known = positions.find(position) != Numbering<Voxel>::kNone;
  if (!is_known && bits == VoxelBlock{}) return std::nullopt;
  const std::uint32_t number = positions.number(position);
  if (!is_known) {
    blocks.emplace_back();
    changed_s.emplace_back();
  }
  if (blocks[number] == bits) return std::nullopt;
  blocks[number] = bits;
  changed_s[number] = now_s;
  return number;
}

// A whole map of the same id (loops were closed) is no other map: what is the same in it is not
// sent again.
void MapLevels::apply(const bus::MapChange& change) {
  now_s_ = static_cast<std::uint32_t>(change.utime_us / 1'000'000);
  const bool is_another = change.map_id != map_id_ || change.resolution != bus::resolution_of(map_);
  if (is_another) return start_over(change);
  if (change.is_whole()) mark_all_stale();
  const bus::AppliedChange applied = bus::apply(change, map_);
  if (applied.replaced) mark_all_stale();
  for (const Voxel& block : applied.changed.occupied) mark_stale(block);
}

void MapLevels::start_over(const bus::MapChange& change) {
  forget();
  map_id_ = change.map_id;
  bus::apply(change, map_);
  levels_[kFine].edge_m = std::max(detail_m_, change.resolution.occupied_m);
  levels_[kCoarse].edge_m = kCoarser * levels_[kFine].edge_m;
  mark_all_stale();
}

void MapLevels::forget() {
  map_ = {};
  map_id_ = 0;
  ++epoch_;
  for (MapLevel& level : levels_) level = MapLevel();
  stale_ = {};
  changed_.clear();
}

void MapLevels::mark_all_stale() {
  for (std::size_t i = 0; i < map_.occupied.block_count(); ++i)
    mark_stale(map_.occupied.block_position(i));
}

void MapLevels::mark_stale(const Voxel& block) {
  for (std::size_t level = 0; level < kLevels; ++level) {
    const VoxelBox shown =
        blocks_that_show(block, map_.occupied.resolution_m(), levels_[level].edge_m);
    for (std::int32_t z = shown.lowest.z; z <= shown.highest.z; ++z)
      for (std::int32_t y = shown.lowest.y; y <= shown.highest.y; ++y)
        for (std::int32_t x = shown.lowest.x; x <= shown.highest.x; ++x)
          stale_[level].insert({x, y, z});
  }
}

std::size_t MapLevels::work_of_block(std::size_t level) const {
  const double along = levels_[level].edge_m / map_.occupied.resolution_m() + 1.0;
  return static_cast<std::size_t>(along * along * along) + 1;
}

void MapLevels::refresh(std::size_t work) {
  for (const std::size_t level : {kCoarse, kFine}) {
    std::set<Voxel>& stale = stale_[level];
    const std::size_t each = stale.empty() ? 0 : work_of_block(level);
    while (!stale.empty() && work >= each) {
      work -= each;
      refresh_block(level, stale.extract(stale.begin()).value());
    }
    if (!stale.empty()) return;
  }
}

void MapLevels::refresh_block(std::size_t which, const Voxel& block) {
  MapLevel& level = levels_[which];
  const VoxelBlock bits = resampled_block(map_.occupied, level.edge_m, block);
  if (const auto number = level.put(block, bits, now_s_)) changed_.push_back({which, *number});
}

std::vector<ChangedBlock> MapLevels::take_changed() { return std::exchange(changed_, {}); }

}  // namespace voxlist::viewing
