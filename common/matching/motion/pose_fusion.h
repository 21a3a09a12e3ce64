#pragma once

#include <Eigen/Core>

#include "voxlist/geometry/uncertain_pose.h"

namespace voxlist::matching {

/// (x, y, yaw) of a pose beside another: m, m, rad.
Eigen::Vector3d difference(const Pose2& a, const Pose2& b);

/// Turns x and y by an angle (rad) and leaves yaw as it is.
Eigen::Matrix3d planar_turn(double angle_rad);

/// What a match tells beside the prior that it began with, taken with more doubt than it claims,
/// together with a prediction. `prior` and `predicted` have the same mean. `matched`: what prior
/// and scan gave together. `scatter`: the covariance that is added to what the scan alone told.
UncertainPose fused(const UncertainPose& predicted, const UncertainPose& prior,
                    const UncertainPose& matched, const Eigen::Matrix3d& scatter);

}  // namespace voxlist::matching
