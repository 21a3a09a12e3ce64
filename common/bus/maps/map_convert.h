#pragma once

#include "voxlist/bus/maps/map_chunks.h"
#include "voxlist/voxels/occupancy_map.h"

namespace voxlist::bus {

MapResolution resolution_of(const OccupancyMap& map);

/// All blocks of the map.
MapBlocks to_messages(const OccupancyMap& map);

/// The map's blocks at these positions, as they are now. Where the map has none, they
/// are empty.
MapBlocks to_messages(const OccupancyMap& map, const ChangedBlocks& positions);

/// What a change did to a map.
struct AppliedChange {
  /// The map is another one now.
  bool replaced = false;
  /// Else the blocks that have gained or lost something; none: nothing changed.
  ChangedBlocks changed;
};

/// Brings a map to the change's version: a whole change replaces it, others set their blocks.
/// Precondition: the change builds on the map, so its voxels are as large; MapAssembler hands out
/// such changes alone.
AppliedChange apply(const MapChange& change, OccupancyMap& map);

}  // namespace voxlist::bus
