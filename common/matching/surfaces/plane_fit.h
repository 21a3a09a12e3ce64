#pragma once

#include <Eigen/Core>
#include <span>

#include "voxlist/voxels/voxel.h"

namespace voxlist::matching {

/// The plane through voxels, in voxels.
struct Plane {
  Eigen::Vector3d mean;
  /// Standard deviations along the plane's axes, smallest first: the first one is its thickness.
  Eigen::Vector3d deviations;
  Eigen::Vector3d normal;

  /// A voxel's signed distance from the plane.
  double distance(const Voxel& v) const {
    return normal.dot(Eigen::Vector3d(v.x, v.y, v.z) - mean);
  }
};

/// The plane of least squares. Sums of coordinates are integers, so it does not depend on the
/// voxels' order. Precondition: at least one voxel; coordinates below 2^15.
Plane fit_plane(std::span<const Voxel> voxels);

/// Variance of a coordinate within a voxel (voxels^2): a plane on the lattice is that thick at
/// least.
inline constexpr double kLatticeVariance = 1.0 / 12.0;

}  // namespace voxlist::matching
