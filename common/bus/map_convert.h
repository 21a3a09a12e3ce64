#pragma once

#include <vector>
#include <voxlist/voxel_block_t.hpp>

#include "bus/map_chunks.h"
#include "voxels/voxel_map.h"

namespace voxlist {

/// The map's blocks at these positions, as they are now. Positions that the map does not have are
/// left out.
std::vector<voxel_block_t> to_messages(const VoxelMap& map,
                                       const std::vector<Voxel>& block_positions);

/// All blocks of the map.
std::vector<voxel_block_t> to_messages(const VoxelMap& map);

/// Brings a map to the change's version: a whole change replaces it, others set their blocks.
/// Returns whether a voxel changed. Precondition: the change builds on the map, as MapAssembler
/// sees to.
bool apply(const MapChange& change, VoxelMap& map);

}  // namespace voxlist
