#pragma once

#include <Eigen/Core>

#include "voxlist/geometry/uncertain_pose.h"
#include "voxlist/matching/motion/tracked_pose.h"

namespace voxlist::matching {

/// What matches scatter by beside what they claim, from one scan to the next: a laser's rings hit
/// other spots of cars and leaves each time, clouds and odometry have other clocks, a mast sways.
/// Odometry tells, and without it the velocity: where they err, each of their ways errs by itself;
/// where a match is off, the way to it is too long and the next one too short. So the variance of
/// that is the negative covariance of one difference of guess and match with the next (Mehra, "On
/// the identification of variances and adaptive Kalman filtering", 1970).
class MatchScatter {
 public:
  /// Where a match should be, and how sure that is: the guess and the scatter.
  UncertainPose expected(const UncertainPose& guess) const;

  /// Corrects a pose that was moved on by a match, each as far as it can be trusted, and learns
  /// what both err by. `matched`: what expected() and the scan gave together.
  void correct(TrackedPose& moved, const UncertainPose& matched);

  /// The scatter of matches in base, as variances of x, y, yaw: m^2, m^2, rad^2.
  Eigen::Vector3d variances() const;

 private:
  void learn(const Eigen::Vector3d& difference);
  Eigen::Matrix3d covariance(const Pose2& pose) const;

  Eigen::Vector3d last_ = Eigen::Vector3d::Zero(), products_ = Eigen::Vector3d::Zero();
  double weight_ = 0.0;
  // How far the last match was off the pose that was believed, in base.
  Eigen::Vector3d off_ = Eigen::Vector3d::Zero();
};

}  // namespace voxlist::matching
