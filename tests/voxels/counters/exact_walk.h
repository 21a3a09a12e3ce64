#pragma once

#include <set>

#include "voxlist/voxels/counters/ray_job.h"
#include "voxlist/voxels/voxel.h"

namespace voxlist {

/// The cells of a ray by Amanatides and Woo, one face after the other, each time of crossing an
/// exact fraction of the whole way: slow and right. Ends and ties as Slabs says.
std::set<Voxel> exact_walk(const FixedRay& ray);

}  // namespace voxlist
