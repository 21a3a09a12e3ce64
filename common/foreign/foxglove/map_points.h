#pragma once

#include <cstdint>
#include <map>

#include "voxlist/bus/convert.h"
#include "voxlist/bus/maps/map_chunks.h"
#include "voxlist/foreign/foxglove/messages.h"
#include "voxlist/voxels/occupancy_map.h"

namespace voxlist::foreign {

/// The map as points: centres of its voxels, doubled in size as long as they are no larger than
/// `detail_m`. As long as nobody tells the map, it is made of keyframes, in voxels of that size.
class MapPoints {
 public:
  explicit MapPoints(double detail_m) : detail_m_(detail_m) {}

  /// How many blocks are new; at least 1 where the map became another one.
  std::size_t apply(const bus::MapChange& change);

  /// A keyframe of a map that nobody tells, or the same one moved. How many blocks of about a
  /// keyframe's size are new; 0: the map is told.
  std::size_t add(const bus::PosedCloud& keyframe);

  std::size_t blocks() const { return map_.occupied.block_count() + kBlocks * keyframes_.size(); }
  std::int64_t utime_us() const { return utime_us_; }
  std::int64_t map_id() const { return map_id_; }

  Packed points() const;

 private:
  // What a keyframe adds to a map, roughly: a room's surfaces.
  static constexpr std::size_t kBlocks = 200;

  VoxelMap map_of_keyframes() const;
  VoxelMap coarser(const VoxelMap& map) const;

  double detail_m_;
  OccupancyMap map_;
  std::map<std::int32_t, bus::PosedCloud> keyframes_;
  std::int64_t utime_us_ = 0, map_id_ = 0;
};

}  // namespace voxlist::foreign
