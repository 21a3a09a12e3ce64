#pragma once

#include <cstdint>
#include <vector>

#include "voxlist/geometry/cloud.h"

namespace voxlist::matching {

/// Those of the points with these indices that have others about them, as the points of surfaces
/// do: rain, dust and the edges of things give points in the middle of nowhere, which no place
/// explains. About a point is within some twelfth of its range. All of them where many are alone:
/// then it is the laser whose rays are far apart. About 1 ms for 5,000 points.
std::vector<std::uint32_t> without_lonely(const Cloud& cloud,
                                          const std::vector<std::uint32_t>& indices);

}  // namespace voxlist::matching
