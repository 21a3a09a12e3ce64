#pragma once

#include "voxlist/voxels/voxel_map.h"

namespace voxlist {

/// A block in voxels twice as large, which lie in its low corner: occupied where any of the eight
/// small ones is (paper, Algorithm 2, by two).
VoxelBlock halved_block(const VoxelBlock& block);

/// The same for all of a map.
VoxelMap halved(const VoxelMap& map);

}  // namespace voxlist
