#pragma once

#include <span>
#include <vector>

#include "voxlist/matching/surfaces/surfels.h"

namespace voxlist::matching {

/// What a cube's voxels are.
enum class CubeShape {
  /// One surface, or the two faces of a thin wall.
  kSurface,
  /// Too few voxels, or a line of them, as one ring of a laser leaves it: a larger cube may tell.
  kTooFew,
  /// Clutter.
  kRough,
};

/// Fits the surfaces of one cube, at most two, into `sides`; `count` is how many. `voxels` are the
/// cube's, counted from `lowest`.
CubeShape fit_surfels(const OccupancyMap& map, const Voxel& lowest, std::span<const Voxel> voxels,
                      const SurfelConfig& config, Surfel sides[2], int& count);

}  // namespace voxlist::matching
