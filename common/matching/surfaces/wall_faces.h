#pragma once

#include <optional>
#include <span>

#include "voxlist/matching/surfaces/plane_fit.h"

namespace voxlist::matching {

/// Where the voxels lie in two layers, the faces of a thin wall, apart by a gap: the distance from
/// the plane through all of them (voxels) that divides one face from the other. Nothing where they
/// are one surface.
std::optional<double> find_gap(const Plane& plane, std::span<const Voxel> voxels,
                               double resolution_m);

}  // namespace voxlist::matching
