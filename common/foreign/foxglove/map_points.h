#pragma once

#include <cstdint>

#include "voxlist/bus/maps/map_chunks.h"
#include "voxlist/foreign/foxglove/messages.h"
#include "voxlist/voxels/occupancy_map.h"

namespace voxlist::foreign {

/// The map as points: centres of its voxels, doubled in size as long as they are no larger than
/// `detail_m`.
class MapPoints {
 public:
  explicit MapPoints(double detail_m) : detail_m_(detail_m) {}

  /// How many blocks are new; at least 1 where the map became another one.
  std::size_t apply(const bus::MapChange& change);

  std::size_t blocks() const { return map_.occupied.block_count(); }
  std::int64_t utime_us() const { return utime_us_; }
  std::int64_t map_id() const { return map_id_; }

  Packed points() const;

 private:
  VoxelMap coarser(const VoxelMap& map) const;

  double detail_m_;
  OccupancyMap map_;
  std::int64_t utime_us_ = 0, map_id_ = 0;
};

}  // namespace voxlist::foreign
