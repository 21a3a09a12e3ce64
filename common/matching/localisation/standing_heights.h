#pragma once

#include <vector>

#include "voxlist/voxels/occupancy_map.h"

namespace voxlist::matching {

/// Heights (m) of a map's floors, the largest floor first: surfaces with free space above them, on
/// which a robot may stand. Of ramps and stairs every 0.3 m or so; table tops are among them where
/// there are square metres of them. At most 16. About 20 ms for 600,000 voxels.
std::vector<double> standing_heights(const OccupancyMap& map);

}  // namespace voxlist::matching
