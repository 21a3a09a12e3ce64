#pragma once

#include "voxlist/voxels/voxel_map.h"

namespace voxlist::matching {

/// Edge of the smallest cells (m; voxels doubled so often) in which the map's surfaces are closed
/// for the most part. In smaller ones, holes are left between the points of few scans, and a scan
/// at its true pose falls through them.
double closed_cell_m(const VoxelMap& map);

}  // namespace voxlist::matching
