#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "voxlist/bus/maps/map_chunks.h"
#include "voxlist/viewing/blocks/map_levels.h"
#include "voxlist/voxels/occupancy_map.h"

namespace voxlist::viewing {

/// Of FREE_SPACE: cells that are free, and such that are occupied.
inline constexpr std::size_t kFreeCells = 0, kOccupiedCells = 1, kSpaceLevels = 2;

/// Free and occupied space as clients get it, kept in step with FREE_SPACE. Both levels have the
/// channel's own cells.
class SpaceLevels {
 public:
  void apply(const bus::MapChange& change);

  /// Shows none from now on.
  void forget();

  /// Each call tells what is new since the last one.
  std::vector<ChangedBlock> take_changed();

  const MapLevel& level(std::size_t which) const { return levels_[which]; }

  /// Counts up when it became another map's, so that numbers of blocks begin anew.
  std::uint32_t epoch() const { return epoch_; }

 private:
  void clear();
  void put(std::size_t level, const VoxelMap& cells, const Voxel& block);
  void put_all(std::size_t level, const VoxelMap& cells);

  OccupancyMap map_;
  std::int64_t map_id_ = 0;
  std::uint32_t now_s_ = 0;
  std::uint32_t epoch_ = 0;
  std::array<MapLevel, kSpaceLevels> levels_;
  std::vector<ChangedBlock> changed_;
};

}  // namespace voxlist::viewing
