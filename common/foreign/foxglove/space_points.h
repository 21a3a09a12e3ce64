#pragma once

#include <cstdint>

#include "voxlist/bus/maps/map_chunks.h"
#include "voxlist/foreign/foxglove/messages.h"
#include "voxlist/voxels/occupancy_map.h"

namespace voxlist::foreign {

/// Free and occupied space (FREE_SPACE) as points: centres of cells of twice the channel's, each
/// with a colour and whether it is occupied. A cell is occupied where any part of it is, else free
/// where any part is.
class SpacePoints {
 public:
  /// How many blocks are new; at least 1 where it became another map's.
  std::size_t apply(const bus::MapChange& change);

  std::size_t blocks() const { return cells_.passed.block_count(); }
  std::int64_t utime_us() const { return utime_us_; }

  Packed points() const;

 private:
  OccupancyMap cells_;
  std::int64_t utime_us_ = 0;
};

}  // namespace voxlist::foreign
