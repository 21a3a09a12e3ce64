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

/// Where the robot is in the map, how fast it moves, and what its odometry is off by, known
/// together: each scan that confirms or corrects a motion tells of all three (a Kalman filter's
/// state).
class TrackedPose {
 public:
  /// The robot stands at this pose, and its odometry errs as odometry usually does.
  explicit TrackedPose(const UncertainPose& pose);

  /// Moves by what odometry tells (T_before_now) in some time (s).
  void follow_odometry(const Pose2& way, double dt_s);

  /// Goes on for some time (s) at its velocity, which changes meanwhile by these standard
  /// deviations (m/s, m/s, rad/s).
  void go_on(double dt_s, const Eigen::Vector3d& change);

  /// Forgets the velocity: 0, by these standard deviations.
  void forget_velocity(const Eigen::Vector3d& sigmas);

  /// The velocity is that of this way (T_before_now) in some time (s), as surely as it is known.
  void set_velocity(const Pose2& way, double dt_s);

  /// Takes pose and velocity for so many times less sure, as variances.
  void doubt(double times);

  /// The pose (x, y, yaw) may be off by this covariance besides: odometry's bias is not the reason.
  void blur(const Eigen::Matrix3d& covariance);

  /// Goes on in another map. `T_new_old`: from the map so far to that one.
  void change_map(const Pose2& T_new_old);

  /// Learns that the pose is known as this: the present one together with what a scan tells.
  void learn(const UncertainPose& pose);

  UncertainPose pose() const { return {pose_, covariance_.topLeftCorner<3, 3>()}; }
  OdometryBias odometry() const;

  /// Variances of the velocity in base: of x, y (m^2/s^2) and yaw (rad^2/s^2).
  Eigen::Vector3d velocity_variances() const;

 private:
  using Covariance = Eigen::Matrix<double, 8, 8>;

  void move_to(const UncertainPose& expected);

  Pose2 pose_;
  // The rest of the state: of the velocity in base (m/s, m/s, rad/s); of odometry's bias,
  // (1 + scale) cos(heading) - 1 and (1 + scale) sin(heading): a way is linear in them.
  Eigen::Matrix<double, 5, 1> rest_ = Eigen::Matrix<double, 5, 1>::Zero();
  // Of (x, y, yaw, velocity, bias).
  Covariance covariance_ = Covariance::Zero();
};

}  // namespace voxlist::matching
