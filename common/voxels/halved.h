#pragma once

#include "voxlist/voxels/voxel_map.h"

namespace voxlist {

/// The same space in voxels twice as large: occupied where any of the eight small ones is (paper,
/// Algorithm 2, by two).
VoxelMap halved(const VoxelMap& map);

}  // namespace voxlist
