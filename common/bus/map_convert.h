#pragma once

#include "bus/map_chunks.h"
#include "voxels/occupancy_map.h"

namespace voxlist {

MapResolution resolution_of(const OccupancyMap& map);

/// All blocks of the map.
MapBlocks to_messages(const OccupancyMap& map);

/// The map's blocks at these positions, as they are now. Positions that the map does not have are
/// left out.
MapBlocks to_messages(const OccupancyMap& map, const ChangedBlocks& positions);

/// Brings a map to the change's version: a whole change replaces it, others set their blocks.
/// Returns whether a voxel or a passed cell changed. Precondition: the change builds on the map, as
/// MapAssembler sees to.
bool apply(const MapChange& change, OccupancyMap& map);

}  // namespace voxlist
