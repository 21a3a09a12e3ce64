#include "voxlist/matching/surfaces/refine.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "voxlist/matching/surfaces/correspondences.h"
#include "voxlist/matching/surfaces/refine_covariance.h"

namespace voxlist::matching {
namespace {

// A turn counts as the way of a point at this range (m) when it is asked whether a step is small:
// the usual range of points in rooms. It decides when to stop, and nothing else.
constexpr double kLever_m = 5.0;

// Points within so many scales of a surface are its inliers: their weight is 1/25 or more.
constexpr double kInlierScales = 2.0;

// The normal equations of the correspondences, and their weighted squares.
template <int kDof>
struct NormalEquations {
  Square<kDof> information = Square<kDof>::Zero();  // its lower triangle
  Step<kDof> gradient = Step<kDof>::Zero();
  double squares = 0.0, weights = 0.0;

  explicit NormalEquations(const std::vector<Correspondence<kDof>>& correspondences) {
    for (const Correspondence<kDof>& c : correspondences) {
      const Step<kDof> weighted = c.weight * c.slope;
      add_lower<kDof>([&](int j) { return weighted * c.slope[j]; }, information);
      gradient += c.weight * c.residual * c.slope;
      squares += c.weight * c.residual * c.residual;
      weights += c.weight;
    }
  }

  // The Gauss-Newton step from a pose that is `off` the prior's mean.
  Step<kDof> step(const Square<kDof>& prior_information, const Step<kDof>& off,
                  double least_sigma_m) const {
    const double variance =
        std::max(squares / std::max(weights, 1.0), least_sigma_m * least_sigma_m);
    return (mirrored<kDof>(information) / variance + prior_information)
        .ldlt()
        .solve(-(gradient / variance + prior_information * off));
  }
};

// How well the points lie on the surfaces.
template <int kDof, class Result>
void tell_inliers(const std::vector<Correspondence<kDof>>& correspondences, std::size_t points,
                  double scale_m, Result& result) {
  double squares = 0.0;
  int inliers = 0;
  for (const Correspondence<kDof>& c : correspondences) {
    if (std::abs(c.residual) >= kInlierScales * scale_m) continue;
    squares += c.residual * c.residual;
    ++inliers;
  }
  if (points > 0) result.inlier_ratio = inliers / static_cast<double>(points);
  if (inliers > 0) result.residual_m = std::sqrt(squares / inliers);
}

// What is known of the pose before: covariance, and how far the start is off the mean.
template <int kDof>
struct Prior {
  Square<kDof> covariance;
  Step<kDof> start_off = Step<kDof>::Zero();
  // It knows more than that the start is near: where surfaces are doubted, it counts.
  bool is_told = false;
};

// Of a start that nothing else is known of.
template <int kDof>
Prior<kDof> prior_of_start(const RefineConfig& config) {
  return {shifts_and_turns<kDof>(config.start_sigma_m, config.start_sigma_rad)
              .cwiseAbs2()
              .asDiagonal()};
}

// Normals that are off by chance drag the pose along what nothing holds, each point a little: as
// far as the prior knows better, the way is taken back. Turns stay: any wall holds them, and far
// better than a lattice does.
template <int kDof>
Step<kDof> way_back(const Square<kDof>& covariance, const Square<kDof>& prior_information,
                    const Step<kDof>& off) {
  Step<kDof> back = -covariance * prior_information * off;
  back.template tail<kDof - kShifts<kDof>>().setZero();
  return back;
}

template <int kDof, class Result>
Pose3 refine_pose(const SurfelMap& surfels, const RayPoints& scan, const Pose3& start,
                  const Prior<kDof>& prior, const RefineConfig& config, Result& result) {
  const Square<kDof> prior_information = prior.covariance.inverse();
  const Step<kDof> lever_m = shifts_and_turns<kDof>(1.0, kLever_m);
  Pose3 pose = start;
  Step<kDof> off = prior.start_off;
  std::vector<Correspondence<kDof>> correspondences;
  LookUps look_ups(scan.points.size());
  for (int i = 0; i < config.max_iterations && !result.converged; ++i) {
    find_correspondences(surfels, scan, pose, config.scale_m, look_ups, correspondences);
    const NormalEquations<kDof> equations(correspondences);
    const Step<kDof> step = equations.step(prior_information, off, config.least_sigma_m);
    move(step, pose);
    off += step;
    result.converged = step.cwiseProduct(lever_m).norm() < config.converged_m;
  }
  result.covariance = covariance_of<kDof>(correspondences, prior.covariance, config.least_sigma_m,
                                          prior.is_told, true);
  move(way_back<kDof>(result.covariance, prior_information, off), pose);
  result.covariance.diagonal() +=
      shifts_and_turns<kDof>(config.map_sigma_m, config.map_sigma_rad).cwiseAbs2();
  tell_inliers(correspondences, scan.points.size(), config.scale_m, result);
  return pose;
}

// Where x, y and yaw are among the coordinates of a spatial pose.
constexpr int kPlanar[] = {0, 1, 5};

// A planar prior of a scan that is level and at the map's height, or nearly.
Prior<6> spatial_prior(const Pose2& start, const UncertainPose& prior, const RefineConfig& config) {
  const double height = config.height_sigma_m, tilt = config.tilt_sigma_rad;
  const double off[] = {start.x_m - prior.pose.x_m, start.y_m - prior.pose.y_m,
                        wrap_angle(start.yaw_rad - prior.pose.yaw_rad)};
  Prior<6> spatial{Square<6>::Zero(), Step<6>::Zero(), true};
  spatial.covariance.diagonal().segment<3>(2) << height * height, tilt * tilt, tilt * tilt;
  for (int i = 0; i < 3; ++i) {
    spatial.start_off(kPlanar[i]) = off[i];
    for (int j = 0; j < 3; ++j) spatial.covariance(kPlanar[i], kPlanar[j]) = prior.covariance(i, j);
  }
  return spatial;
}

Eigen::Matrix3d planar(const Square<6>& spatial) {
  Eigen::Matrix3d covariance;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) covariance(i, j) = spatial(kPlanar[i], kPlanar[j]);
  return covariance;
}

}  // namespace

Refinement refine(const SurfelMap& surfels, const RayPoints& scan, const Pose2& start,
                  const RefineConfig& config) {
  Refinement result;
  result.pose = to_pose2(
      refine_pose<3>(surfels, scan, to_pose3(start), prior_of_start<3>(config), config, result));
  return result;
}

Refinement refine(const SurfelMap& surfels, const RayPoints& scan, const Pose2& start,
                  const UncertainPose& prior, const RefineConfig& config) {
  SpatialRefinement spatial;
  const Pose3 pose = refine_pose<6>(surfels, scan, to_pose3(start),
                                    spatial_prior(start, prior, config), config, spatial);
  return {to_pose2(pose), planar(spatial.covariance), spatial.inlier_ratio, spatial.residual_m,
          spatial.converged};
}

Eigen::Matrix3d covariance_without_lines(const SurfelMap& surfels, const RayPoints& scan,
                                         const Pose2& pose, const Eigen::Matrix3d& before,
                                         const RefineConfig& config) {
  std::vector<Correspondence<6>> correspondences;
  LookUps look_ups(scan.points.size());
  find_correspondences(surfels, scan, to_pose3(pose), config.scale_m, look_ups, correspondences);
  const Prior<6> prior = spatial_prior(pose, {pose, before}, config);
  return planar(
      covariance_of<6>(correspondences, prior.covariance, config.least_sigma_m, true, false));
}

SpatialRefinement refine(const SurfelMap& surfels, const RayPoints& scan, const Pose3& start,
                         const RefineConfig& config) {
  SpatialRefinement result;
  result.pose = refine_pose<6>(surfels, scan, start, prior_of_start<6>(config), config, result);
  return result;
}

}  // namespace voxlist::matching
