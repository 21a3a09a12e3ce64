#pragma once

#include <Eigen/Core>
#include <span>

#include "geometry/pose.h"
#include "matching/surfels.h"

namespace voxlist {

struct RefineConfig {
  /// Residual (m) at which a point's weight has fallen to a quarter.
  double scale_m = 0.05;
  int max_iterations = 30;
  /// Stops when a step is smaller than this (m at the points' typical range).
  double converged_m = 1e-4;
  /// Standard deviation of the start, which holds the directions that the surfaces leave free (m,
  /// rad).
  double start_sigma_m = 0.15;
  double start_sigma_rad = 0.02;
};

struct Refinement {
  Pose2 pose;
  /// Covariance of (x, y, yaw): m^2, m rad, rad^2.
  Eigen::Matrix3d covariance;
  /// Points that lie on a surface of the map within 2 scale_m, as a share of all points, 0..1.
  double inlier_share = 0.0;
  /// Root mean square distance of those points from their surfaces (m).
  double residual_m = 0.0;
  bool converged = false;
};

/// Moves a pose to where the scan's points lie best on the map's surfaces: point-to-plane
/// Gauss-Newton with Geman-McClure weights. `start` must be within about half a surfel's edge of
/// the answer.
Refinement refine(const SurfelMap& surfels, std::span<const Eigen::Vector3f> points,
                  const Pose2& start, const RefineConfig& config = {});

}  // namespace voxlist
