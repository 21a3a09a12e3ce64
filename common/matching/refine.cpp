#include "matching/refine.h"

#include <Eigen/Cholesky>
#include <cmath>

namespace voxlist {
namespace {

// The normal equations of one Gauss-Newton step over (x, y, yaw), and how well the points lie on
// the surfaces.
struct Linearised {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  double weighted_squares = 0.0, weights = 0.0;
  double inlier_squares = 0.0;
  int inliers = 0;
};

Linearised linearise(const SurfelMap& surfels, std::span<const Eigen::Vector3f> points,
                     const Pose2& pose, double scale_m) {
  Linearised sums;
  const double c = std::cos(pose.yaw_rad), s = std::sin(pose.yaw_rad), scale2 = scale_m * scale_m;
  for (const auto& point : points) {
    const double x = c * point.x() - s * point.y(), y = s * point.x() + c * point.y();
    const Eigen::Vector3d p(pose.x_m + x, pose.y_m + y, point.z());
    const Surfel* surfel = surfels.find(p);
    if (!surfel) continue;
    const Eigen::Vector3d& n = surfel->normal;
    const double residual = n.dot(p - surfel->mean), squared = residual * residual;
    if (squared < 4.0 * scale2) {
      sums.inlier_squares += squared;
      ++sums.inliers;
    }
    const double falloff = scale2 / (scale2 + squared), weight = falloff * falloff;
    const Eigen::Vector3d J(n.x(), n.y(), n.y() * x - n.x() * y);
    sums.information += weight * J * J.transpose();
    sums.gradient += weight * residual * J;
    sums.weighted_squares += weight * squared;
    sums.weights += weight;
  }
  return sums;
}

}  // namespace

Refinement refine(const SurfelMap& surfels, std::span<const Eigen::Vector3f> points,
                  const Pose2& start, const RefineConfig& config) {
  Refinement result;
  result.pose = start;
  const double start_m = 1.0 / (config.start_sigma_m * config.start_sigma_m);
  const double start_rad = 1.0 / (config.start_sigma_rad * config.start_sigma_rad);
  const Eigen::Vector3d start_information(start_m, start_m, start_rad);
  // A step's size in metres: turning counts at a few metres' range.
  const Eigen::Vector3d lever_m(1.0, 1.0, 5.0);
  Linearised sums;
  for (int i = 0; i <= config.max_iterations; ++i) {
    sums = linearise(surfels, points, result.pose, config.scale_m);
    // Points on a surface are as uncertain as they scatter, and neighbours err together: hence at
    // least half the scale.
    const double variance = std::max(sums.weighted_squares / std::max(sums.weights, 1.0),
                                     0.25 * config.scale_m * config.scale_m);
    const Eigen::Vector3d moved(result.pose.x_m - start.x_m, result.pose.y_m - start.y_m,
                                wrap_angle(result.pose.yaw_rad - start.yaw_rad));
    Eigen::Matrix3d information = sums.information / variance;
    information.diagonal() += start_information;
    const Eigen::Vector3d gradient =
        sums.gradient / variance + start_information.cwiseProduct(moved);
    const Eigen::LDLT<Eigen::Matrix3d> solver(information);
    result.covariance = solver.solve(Eigen::Matrix3d::Identity());
    if (result.converged || i == config.max_iterations) break;
    const Eigen::Vector3d step = solver.solve(-gradient);
    result.pose = {result.pose.x_m + step.x(), result.pose.y_m + step.y(),
                   wrap_angle(result.pose.yaw_rad + step.z())};
    result.converged = step.cwiseProduct(lever_m).norm() < config.converged_m;
  }
  if (!points.empty())
    result.inlier_share = static_cast<double>(sums.inliers) / static_cast<double>(points.size());
  if (sums.inliers > 0) result.residual_m = std::sqrt(sums.inlier_squares / sums.inliers);
  return result;
}

}  // namespace voxlist
