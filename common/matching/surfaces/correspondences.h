#pragma once

#include <Eigen/Core>
#include <vector>

#include "voxlist/matching/scan/match_points.h"
#include "voxlist/matching/surfaces/pose_step.h"
#include "voxlist/matching/surfaces/surfels.h"

namespace voxlist::matching {

/// A point of a scan and the surfel that it lies on or near.
template <int kDof>
struct Correspondence {
  const Surfel* surfel;
  /// From base to the point, in map's axes (m).
  Eigen::Vector3d arm;
  /// How the residual changes with the pose.
  Step<kDof> slope;
  /// The point's signed distance from the surfel's plane (m).
  double residual;
  /// Geman and McClure's weight, 0..1: 1 on the plane, a quarter at a distance of scale_m.
  double weight;
};

/// Where each point of a scan was looked up last: mostly the same cube in the next iteration.
using LookUps = std::vector<SurfelMap::LookUp>;

/// Finds the surfel of each point that lies in a cube with one on which its ray may have ended, for
/// kDof = 3 or 6, in the place of what `found` held. `look_ups` has one entry for each point of the
/// scan.
template <int kDof>
void find_correspondences(const SurfelMap& surfels, const RayPoints& scan, const Pose3& pose,
                          double scale_m, LookUps& look_ups,
                          std::vector<Correspondence<kDof>>& found);

}  // namespace voxlist::matching
