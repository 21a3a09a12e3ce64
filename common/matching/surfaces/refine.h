#pragma once

#include <Eigen/Core>

#include "voxlist/geometry/pose.h"
#include "voxlist/geometry/uncertain_pose.h"
#include "voxlist/matching/scan/match_points.h"
#include "voxlist/matching/surfaces/surfels.h"

namespace voxlist::matching {

struct RefineConfig {
  /// Residual (m) at which a point's weight has fallen to a quarter: two to three times the noise
  /// of scanner and map. With 0.02 up to 5 % of starts end elsewhere, with 0.15 furniture that was
  /// moved drags poses along (a median of 3.3 mm instead of 2.2; bench_tracking 40 1, changed
  /// floor).
  double scale_m = 0.05;
  /// Most iterations: it bounds the time of a bad start. With 3, up to 2.5 % of the scans are not
  /// found, with 6 all are (bench_tracking 40 1); where little holds a pose, it takes more.
  int max_iterations = 12;
  /// Stops when a step is smaller than this (m; a turn counts as the way at 5 m): a fifth of the
  /// error that remains, about 1 mm (bench_tracking). Larger: poses stop early where little holds
  /// them.
  double converged_m = 2e-4;
  /// Standard deviation of a start that nothing else is known of (m, rad): above what a search on
  /// cells of 0.04 to 0.08 m leaves, so that the surfaces decide. Where they hold its shifts no
  /// better, these stay as they were.
  double start_sigma_m = 0.15;
  double start_sigma_rad = 0.02;
  /// Points scatter at least this much about a surface (m), half a finest voxel: below it, the
  /// lattice hides how much. Real scans scatter more (0.002 changes nothing in bench_tracking 40
  /// 1).
  double least_sigma_m = 0.01;
  /// Standard deviation of what all of the map's surfaces in sight are off by together (m, rad):
  /// its own scans were misplaced, which leaves no residual, so no pose is surer. These fit maps
  /// whose scans were misplaced by 5 mm and 1 mrad, each by itself.
  double map_sigma_m = 0.0012;
  double map_sigma_rad = 0.0002;
  /// How far a scan that should be level and at the map's height may be off (m, rad), as standard
  /// deviations, where a prior of its planar pose is known: a vehicle that brakes, a mount. Without
  /// it (0) a drive on a street (16 rings, walls to 8 m high) is off by 0.17 m instead of 0.11;
  /// with 0.005 or 0.035 rad it is the same.
  double tilt_sigma_rad = 0.0175;
  double height_sigma_m = 0.03;
};

/// A refined pose, with what was moved: (x, y, yaw) or (x, y, z, roll, pitch, yaw).
template <class Pose, int kDof>
struct RefinementOf {
  Pose pose;
  /// Covariance of the moved coordinates, in their order, errors of the map included: m^2, m rad,
  /// rad^2. The turns of a spatial pose are about map's axes.
  Eigen::Matrix<double, kDof, kDof> covariance;
  /// Points that lie within 2 scale_m of a surface of the map, as a share of all points, 0..1.
  double inlier_ratio = 0.0;
  /// Root mean square distance of those points from their surfaces (m).
  double residual_m = 0.0;
  bool converged = false;
};
using Refinement = RefinementOf<Pose2, 3>;
using SpatialRefinement = RefinementOf<Pose3, 6>;

/// Moves a pose to where the scan's points lie best on those sides of the map's surfaces that their
/// rays could see: point-to-plane Gauss-Newton with Geman-McClure weights. `start` must be within
/// about half a surfel's edge of the answer.
Refinement refine(const SurfelMap& surfels, const RayPoints& scan, const Pose2& start,
                  const RefineConfig& config = {});

/// The same from a start of which more is known than config's standard deviation: by the motion
/// since another scan. Each direction is as the surfaces or `prior` have it, whoever knows it
/// better. Height, roll and pitch are refined with it, and not told.
Refinement refine(const SurfelMap& surfels, const RayPoints& scan, const Pose2& start,
                  const UncertainPose& prior, const RefineConfig& config = {});

/// The covariance of a pose that refine() gave, if what may be single lines of a scan is left out
/// of the map's surfaces. `before`: what was known of it by the motion.
Eigen::Matrix3d covariance_without_lines(const SurfelMap& surfels, const RayPoints& scan,
                                         const Pose2& pose, const Eigen::Matrix3d& before,
                                         const RefineConfig& config = {});

/// The same with height, roll and pitch: needs points on floors or ceilings too.
SpatialRefinement refine(const SurfelMap& surfels, const RayPoints& scan, const Pose3& start,
                         const RefineConfig& config = {});

}  // namespace voxlist::matching
