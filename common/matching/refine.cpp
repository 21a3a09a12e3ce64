#include "matching/refine.h"

#include <Eigen/Cholesky>
#include <cmath>

namespace voxlist {
namespace {

// A step of a pose: what can be moved, as a part of (x, y, z, roll, pitch, yaw) about map's axes.
template <int kDof>
using Step = Eigen::Matrix<double, kDof, 1>;
template <int kDof>
using Square = Eigen::Matrix<double, kDof, kDof>;

// How a point's distance from a plane with normal n changes; `arm` is from base to the point.
template <int kDof>
Step<kDof> slope(const Eigen::Vector3d& n, const Eigen::Vector3d& arm) {
  if constexpr (kDof == 3)
    return {n.x(), n.y(), arm.x() * n.y() - arm.y() * n.x()};
  else
    return (Step<6>() << n, arm.cross(n)).finished();
}

template <int kDof>
constexpr int kShifts = kDof == 3 ? 2 : 3;  // of a step's coordinates; the others are turns

void move(const Step<3>& step, Pose3& pose) {
  pose.translation().head<2>() += step.head<2>();
  pose.linear() = Eigen::AngleAxisd(step.z(), Eigen::Vector3d::UnitZ()) * pose.linear();
}

void move(const Step<6>& step, Pose3& pose) {
  const Eigen::Vector3d turn = step.tail<3>();
  const double angle = turn.norm();
  pose.translation() += step.head<3>();
  if (angle > 0.0) pose.linear() = Eigen::AngleAxisd(angle, turn / angle) * pose.linear();
}

// The normal equations of one Gauss-Newton step, and how well the points lie on the surfaces.
template <int kDof>
struct Linearised {
  Square<kDof> information = Square<kDof>::Zero();
  Step<kDof> gradient = Step<kDof>::Zero();
  double weighted_squares = 0.0, weights = 0.0;
  double inlier_squares = 0.0;
  int inliers = 0;
};

template <int kDof>
Linearised<kDof> linearise(const SurfelMap& surfels, const RayPoints& scan, const Pose3& pose,
                           double scale_m) {
  Linearised<kDof> sums;
  const Eigen::Matrix3d turn = pose.linear();
  const Eigen::Vector3d base = pose.translation();
  const double scale2 = scale_m * scale_m;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const Eigen::Vector3d arm = turn * scan.points[i].cast<double>(), p = base + arm;
    const Eigen::Vector3d origin =
        scan.origins.empty() ? base : (base + turn * scan.origins[i].cast<double>()).eval();
    const Surfel* surfel = surfels.find(p, origin);
    if (!surfel) continue;
    const double residual = surfel->normal.dot(p - surfel->mean), squared = residual * residual;
    if (squared < 4.0 * scale2) {
      sums.inlier_squares += squared;
      ++sums.inliers;
    }
    const double falloff = scale2 / (scale2 + squared), weight = falloff * falloff;
    const Step<kDof> J = slope<kDof>(surfel->normal, arm);
    sums.information += weight * J * J.transpose();
    sums.gradient += weight * residual * J;
    sums.weighted_squares += weight * squared;
    sums.weights += weight;
  }
  return sums;
}

template <int kDof, class Result>
Pose3 refine_pose(const SurfelMap& surfels, const RayPoints& scan, const Pose3& start,
                  const RefineConfig& config, Result& result) {
  constexpr int kShift = kShifts<kDof>, kTurn = kDof - kShift;
  Pose3 pose = start;
  Step<kDof> start_information, lever_m, moved = Step<kDof>::Zero();
  start_information << Step<kDof>::Constant(1.0).template head<kShift>() /
                           (config.start_sigma_m * config.start_sigma_m),
      Step<kDof>::Constant(1.0).template tail<kTurn>() /
          (config.start_sigma_rad * config.start_sigma_rad);
  // A step's size in metres: turning counts at a few metres' range.
  lever_m.template head<kShift>().setConstant(1.0);
  lever_m.template tail<kTurn>().setConstant(5.0);
  Linearised<kDof> sums;
  for (int i = 0; i <= config.max_iterations; ++i) {
    sums = linearise<kDof>(surfels, scan, pose, config.scale_m);
    // Points on a surface are as uncertain as they scatter, and neighbours err together: hence at
    // least half the scale.
    const double variance = std::max(sums.weighted_squares / std::max(sums.weights, 1.0),
                                     0.25 * config.scale_m * config.scale_m);
    Square<kDof> information = sums.information / variance;
    information.diagonal() += start_information;
    const Step<kDof> gradient = sums.gradient / variance + start_information.cwiseProduct(moved);
    const Eigen::LDLT<Square<kDof>> solver(information);
    result.covariance = solver.solve(Square<kDof>::Identity());
    if (result.converged || i == config.max_iterations) break;
    const Step<kDof> step = solver.solve(-gradient);
    move(step, pose);
    moved += step;
    result.converged = step.cwiseProduct(lever_m).norm() < config.converged_m;
  }
  if (!scan.points.empty())
    result.inlier_share =
        static_cast<double>(sums.inliers) / static_cast<double>(scan.points.size());
  if (sums.inliers > 0) result.residual_m = std::sqrt(sums.inlier_squares / sums.inliers);
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

}  // namespace voxlist
