#pragma once

#include <span>
#include <vector>

#include "voxlist/matching/surfaces/surfels.h"

namespace voxlist::matching {

/// Fits the surfaces of one cube: none, one, or the two faces of a thin wall, into `sides`; gives
/// how many. `voxels` are the cube's, counted from `lowest`.
int fit_surfels(const OccupancyMap& map, const Voxel& lowest, std::span<const Voxel> voxels,
                const SurfelConfig& config, Surfel sides[2]);

}  // namespace voxlist::matching
