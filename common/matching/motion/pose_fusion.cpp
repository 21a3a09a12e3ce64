#include "voxlist/matching/motion/pose_fusion.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "voxlist/geometry/elementary.h"

namespace voxlist::matching {
namespace {

// The match's information without the prior's: none where the match is no surer.
Eigen::Matrix3d told_beside(const Eigen::Matrix3d& prior, const Eigen::Matrix3d& matched) {
  const Eigen::LLT<Eigen::Matrix3d> root(prior);
  const Eigen::Matrix3d in_units = root.matrixL().solve(root.matrixL().solve(matched).transpose());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(in_units);
  const Eigen::Vector3d told = (axes.eigenvalues().cwiseInverse().array() - 1.0).cwiseMax(0.0);
  const Eigen::Matrix3d back = root.matrixU().solve(axes.eigenvectors());
  return back * told.asDiagonal() * back.transpose();
}

}  // namespace

Eigen::Vector3d difference(const Pose2& a, const Pose2& b) {
  return {a.x_m - b.x_m, a.y_m - b.y_m, wrap_angle(a.yaw_rad - b.yaw_rad)};
}

Eigen::Matrix3d planar_turn(double angle_rad) {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  const auto [sine, cosine] = elementary::sine_cosine(angle_rad);
  turn.topLeftCorner<2, 2>() << cosine, -sine, sine, cosine;
  return turn;
}

UncertainPose fused(const UncertainPose& predicted, const UncertainPose& prior,
                    const UncertainPose& matched, const Eigen::Matrix3d& scatter) {
  const Eigen::Matrix3d one = Eigen::Matrix3d::Identity(),
                        told = told_beside(prior.covariance, matched.covariance);
  // The scan's own place times its information, from the prior's mean.
  const Eigen::Vector3d pull = matched.covariance.inverse() * difference(matched.pose, prior.pose);
  const Eigen::Matrix3d doubt = (one + told * scatter).inverse();
  const Eigen::Matrix3d covariance = (predicted.covariance.inverse() + doubt * told).inverse();
  const Eigen::Vector3d shift = covariance * (doubt * pull);
  return {{predicted.pose.x_m + shift(0), predicted.pose.y_m + shift(1),
           wrap_angle(predicted.pose.yaw_rad + shift(2))},
          (covariance + covariance.transpose()) / 2.0};
}

}  // namespace voxlist::matching
