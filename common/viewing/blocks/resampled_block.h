#pragma once

#include "voxlist/voxels/voxel_map.h"

namespace voxlist::viewing {

/// The block of a coarser lattice at a position: a voxel of edge_m is occupied where the centre of
/// one of the map's voxels lies in it. Precondition: edge_m >= the map's resolution.
VoxelBlock resampled_block(const VoxelMap& map, double edge_m, const Voxel& block);

/// The blocks of voxels of to_m in which centres of voxels of a block of from_m may lie.
VoxelBox blocks_that_show(const Voxel& block, double from_m, double to_m);

}  // namespace voxlist::viewing
