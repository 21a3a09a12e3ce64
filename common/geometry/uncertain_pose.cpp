#include "voxlist/geometry/uncertain_pose.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "voxlist/geometry/elementary.h"

namespace voxlist {

UncertainPose UncertainPose::operator*(const UncertainPose& T_b_c) const {
  UncertainPose result{pose * T_b_c.pose};
  Eigen::Matrix3d lever = Eigen::Matrix3d::Identity(), turn = Eigen::Matrix3d::Identity();
  lever(0, 2) = pose.y_m - result.pose.y_m;
  lever(1, 2) = result.pose.x_m - pose.x_m;
  const auto [sine, cosine] = elementary::sine_cosine(pose.yaw_rad);
  turn.topLeftCorner<2, 2>() << cosine, -sine, sine, cosine;
  result.covariance =
      lever * covariance * lever.transpose() + turn * T_b_c.covariance * turn.transpose();
  return result;
}

double worst_sigma_m(const Eigen::Matrix3d& covariance) {
  const Eigen::Matrix2d position = covariance.topLeftCorner<2, 2>();
  const double mean = position.trace() / 2.0;
  return std::sqrt(mean + std::sqrt(std::max(0.0, mean * mean - position.determinant())));
}

double mahalanobis2(const Pose2& pose, const UncertainPose& other) {
  const Eigen::Vector3d off{pose.x_m - other.pose.x_m, pose.y_m - other.pose.y_m,
                            wrap_angle(pose.yaw_rad - other.pose.yaw_rad)};
  return off.dot(other.covariance.llt().solve(off));
}

}  // namespace voxlist
