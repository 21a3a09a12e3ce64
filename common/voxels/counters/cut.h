#pragma once

#include <optional>

#include "voxlist/voxels/counters/counter_map.h"

namespace voxlist {

/// A part of a map of counters: the cells of a box, where one is given, in cells that may be
/// larger. A larger cell has the highest count of the cells whose centres are in it, as a node of
/// an octree has: it is occupied where one of them is, else free where one is, else unknown.
/// Precondition: resolution_m is not below the map's.
CounterMap cut(const CounterMap& map, double resolution_m,
               const std::optional<VoxelBox>& box = std::nullopt);

}  // namespace voxlist
