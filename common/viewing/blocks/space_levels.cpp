#include "voxlist/viewing/blocks/space_levels.h"

#include <utility>

#include "voxlist/bus/maps/map_convert.h"

namespace voxlist::viewing {

// Where a whole map of the same id replaces what was there (loops were closed), what is the same in
// it is not sent again.
void SpaceLevels::apply(const bus::MapChange& change) {
  now_s_ = static_cast<std::uint32_t>(change.utime_us / 1'000'000);
  if (change.map_id != map_id_ || change.resolution != bus::resolution_of(map_)) {
    clear();
    map_id_ = change.map_id;
    for (MapLevel& level : levels_) level.edge_m = change.resolution.passed_m;
  }
  const bus::AppliedChange applied = bus::apply(change, map_);
  if (applied.replaced) {
    put_all(kFreeCells, map_.passed);
    put_all(kOccupiedCells, map_.occupied);
    return;
  }
  for (const Voxel& block : applied.changed.passed) put(kFreeCells, map_.passed, block);
  for (const Voxel& block : applied.changed.occupied) put(kOccupiedCells, map_.occupied, block);
}

void SpaceLevels::forget() {
  if (map_id_ != 0) clear();
}

void SpaceLevels::clear() {
  map_ = {};
  map_id_ = 0;
  ++epoch_;
  levels_ = {};
  changed_.clear();
}

std::vector<ChangedBlock> SpaceLevels::take_changed() { return std::exchange(changed_, {}); }

void SpaceLevels::put(std::size_t level, const VoxelMap& cells, const Voxel& block) {
  const VoxelBlock* bits = cells.find_block(block);
  const auto number = levels_[level].put(block, bits ? *bits : VoxelBlock{}, now_s_);
  if (number) changed_.push_back({level, *number});
}

// All that the map has, and all that it had before.
void SpaceLevels::put_all(std::size_t level, const VoxelMap& cells) {
  for (std::uint32_t i = 0; i < levels_[level].size(); ++i)
    put(level, cells, levels_[level].positions.key(i));
  for (std::size_t i = 0; i < cells.block_count(); ++i) put(level, cells, cells.block_position(i));
}

}  // namespace voxlist::viewing
