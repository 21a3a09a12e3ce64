#pragma once

#include <filesystem>
#include <vector>

#include "voxlist/drawing/map_picture.h"
#include "voxlist/geometry/cloud.h"
#include "voxlist/voxels/occupancy_map.h"

namespace voxlist::mapping {

/// Writes into a map folder what people and other programs look at, each file atomically: map.png
/// (from above and from the side, with the path and what is free), map.ply (voxel centres, coloured
/// by height), trajectory.tum (the poses). Loops that were `closed` are drawn as well. Throws
/// FileError.
void write_map_views(const std::filesystem::path& folder, const OccupancyMap& map,
                     const std::vector<StampedPose3>& trajectory,
                     const drawing::ClosedLoops& closed = {});

}  // namespace voxlist::mapping
