#pragma once

#include <Eigen/Core>

#include "voxlist/geometry/pose.h"

namespace voxlist {

/// A planar pose T_a_b, and how sure it is.
struct UncertainPose {
  Pose2 pose;
  /// Of (x, y, yaw) in a's axes: m^2, m rad, rad^2.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();

  /// T_a_c = T_a_b * T_b_c, where the two err independently.
  UncertainPose operator*(const UncertainPose& T_b_c) const;
};

/// Standard deviation (m) of the position in the direction in which it is least sure. `covariance`
/// is of (x, y, yaw).
double worst_sigma_m(const Eigen::Matrix3d& covariance);

/// The square of the distance of a pose from another in units of its standard deviations: 3 in the
/// mean of poses that err as it says. The covariance must be positive definite.
double mahalanobis2(const Pose2& pose, const UncertainPose& other);

}  // namespace voxlist
