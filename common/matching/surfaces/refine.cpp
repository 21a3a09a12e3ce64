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
  Square<kDof> information = Square<kDof>::Zero();
  Step<kDof> gradient = Step<kDof>::Zero();
  double squares = 0.0, weights = 0.0;

  explicit NormalEquations(const std::vector<Correspondence<kDof>>& correspondences) {
    for (const Correspondence<kDof>& c : correspondences) {
      information += c.weight * c.slope * c.slope.transpose();
      gradient += c.weight * c.residual * c.slope;
      squares += c.weight * c.residual * c.residual;
      weights += c.weight;
    }
  }

  // The Gauss-Newton step from a pose that has `moved` from a start of the given information.
  Step<kDof> step(const Step<kDof>& start_information, const Step<kDof>& moved,
                  double least_sigma_m) const {
    const double variance =
        std::max(squares / std::max(weights, 1.0), least_sigma_m * least_sigma_m);
    Square<kDof> all = information / variance;
    all.diagonal() += start_information;
    return all.ldlt().solve(-(gradient / variance + start_information.cwiseProduct(moved)));
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

// Normals that are off by chance drag the pose along what nothing holds, each point a little: as
// far as the start knows better, the way is taken back. Turns stay: any wall holds them, and far
// better than a lattice does.
template <int kDof>
Step<kDof> way_back(const Square<kDof>& covariance, const Step<kDof>& start_information,
                    const Step<kDof>& moved) {
  Step<kDof> back = -covariance * start_information.cwiseProduct(moved);
  back.template tail<kDof - kShifts<kDof>>().setZero();
  return back;
}

template <int kDof, class Result>
Pose3 refine_pose(const SurfelMap& surfels, const RayPoints& scan, const Pose3& start,
                  const RefineConfig& config, Result& result) {
  const Step<kDof> start_sigma =
      shifts_and_turns<kDof>(config.start_sigma_m, config.start_sigma_rad);
  const Step<kDof> start_information = start_sigma.array().square().inverse();
  const Step<kDof> lever_m = shifts_and_turns<kDof>(1.0, kLever_m);
  Pose3 pose = start;
  Step<kDof> moved = Step<kDof>::Zero();
  std::vector<Correspondence<kDof>> correspondences;
  LookUps look_ups(scan.points.size());
  for (int i = 0; i < config.max_iterations && !result.converged; ++i) {
    correspondences = find_correspondences<kDof>(surfels, scan, pose, config.scale_m, look_ups);
    const NormalEquations<kDof> equations(correspondences);
    const Step<kDof> step = equations.step(start_information, moved, config.least_sigma_m);
    move(step, pose);
    moved += step;
    result.converged = step.cwiseProduct(lever_m).norm() < config.converged_m;
  }
  result.covariance = covariance_of<kDof>(correspondences, start_sigma, config.least_sigma_m);
  move(way_back<kDof>(result.covariance, start_information, moved), pose);
  result.covariance.diagonal() +=
      shifts_and_turns<kDof>(config.map_sigma_m, config.map_sigma_rad).cwiseAbs2();
  tell_inliers(correspondences, scan.points.size(), config.scale_m, result);
  return pose;
}

}  // namespace

Refinement refine(const SurfelMap& surfels, const RayPoints& scan, const Pose2& start,
                  const RefineConfig& config) {
  Refinement result;
  const Pose3 pose = refine_pose<3>(surfels, scan, to_pose3(start), config, result);
  result.pose = to_pose2(pose);
  return result;
}

SpatialRefinement refine(const SurfelMap& surfels, const RayPoints& scan, const Pose3& start,
                         const RefineConfig& config) {
  SpatialRefinement result;
  result.pose = refine_pose<6>(surfels, scan, start, config, result);
  return result;
}

}  // namespace voxlist::matching
