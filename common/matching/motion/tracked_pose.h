#pragma once

#include <Eigen/Core>

#include "voxlist/geometry/uncertain_pose.h"

namespace voxlist::matching {

/// What odometry's ways are off by, for as long as wheels and mounts stay as they are: a way that
/// it tells is turned by `heading_rad` and taken (1 + scale) times.
struct OdometryBias {
  double scale = 0.0, heading_rad = 0.0;
  /// Their standard deviations.
  double scale_sigma = 0.0, heading_sigma_rad = 0.0;
};

/// Where the robot is in the map and what its odometry is off by, known together: each way that
/// scans confirm or correct tells of both (a Kalman filter's state).
class TrackedPose {
 public:
  /// The robot is at this pose; its odometry errs as odometry usually does.
  explicit TrackedPose(const UncertainPose& pose);

  /// Moves by what odometry tells (T_before_now).
  void follow_odometry(const Pose2& way);

  /// Moves to where something else expects the robot now.
  void move_to(const UncertainPose& expected);

  /// Goes on in another map. `T_new_old`: from the map so far to that one.
  void change_map(const Pose2& T_new_old);

  /// Learns that the pose is known as this: the present one together with what a scan tells.
  void learn(const UncertainPose& pose);

  UncertainPose pose() const { return {pose_, covariance_.topLeftCorner<3, 3>()}; }
  OdometryBias odometry() const;

 private:
  Pose2 pose_;
  // (1 + scale) cos(heading) - 1 and (1 + scale) sin(heading): a way is linear in them.
  Eigen::Vector2d bias_ = Eigen::Vector2d::Zero();
  // Of (x, y, yaw, bias).
  Eigen::Matrix<double, 5, 5> covariance_ = Eigen::Matrix<double, 5, 5>::Zero();
};

}  // namespace voxlist::matching
