#pragma once

#include <span>
#include <vector>

#include "voxlist/mapping/graph/pose_graph.h"
#include "voxlist/mapping/graph/spatial_edge.h"

namespace voxlist::mapping {

/// As solve() of planar poses, in all six coordinates: the poses that fit best what the edges say,
/// from a start that is off by less than a radian. The first pose stays where it is. Sums go in the
/// order of the edges, in one thread, without BLAS: the same bits on every machine.
std::vector<Pose3> solve(std::vector<Pose3> poses, std::span<const SpatialEdge> trusted,
                         std::span<const SpatialEdge> doubted = {},
                         Kernel kernel = Kernel::kSquare);

/// A tilt in steps of 0.1 mm and 0.001 deg.
Tilt rounded(const Tilt& tilt);

}  // namespace voxlist::mapping
