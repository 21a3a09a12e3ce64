#pragma once

#include <span>

#include "voxlist/voxels/voxel_map.h"

namespace voxlist::matching {

/// The overlap o = |L and M| (paper, equation 2): how many voxels of the scan, each moved by
/// `offset`, are occupied in the map. Preconditions: the scan's voxels are distinct and of the
/// map's resolution; |scan voxel + offset| < 2^31.
int overlap(std::span<const Voxel> scan, const VoxelMap& map, const Voxel& offset = {});

}  // namespace voxlist::matching
