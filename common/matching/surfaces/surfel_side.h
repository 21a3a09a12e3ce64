#pragma once

#include <span>

#include "voxlist/matching/surfaces/surfels.h"

namespace voxlist::matching {

/// Turns the normal of a surfel to the side where more rays passed, and says whether they passed on
/// that side alone. `voxels` are the surfel's, counted from `lowest`.
void find_side(const OccupancyMap& map, std::span<const Voxel> voxels, const Voxel& lowest,
               Surfel& surfel);

}  // namespace voxlist::matching
