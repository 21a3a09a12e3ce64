#pragma once

#include <Eigen/Geometry>

namespace voxlist {

/// An angle brought into (-pi, pi]. NaN stays NaN.
double wrap_angle(double angle_rad);

/// A planar rigid transform, written T_a_b: it takes coordinates in frame b to frame a,
/// p_a = R(yaw) p_b + (x, y). Heights (z) pass through unchanged.
struct Pose2 {
  double x_m = 0.0;
  double y_m = 0.0;
  double yaw_rad = 0.0;

  /// T_a_c = T_a_b * T_b_c.
  Pose2 operator*(const Pose2& T_b_c) const;

  /// T_b_a.
  Pose2 inverse() const;

  /// A point of frame b in frame a.
  Eigen::Vector3d operator*(const Eigen::Vector3d& p_b) const;

  bool operator==(const Pose2&) const = default;
};

/// The first `share` of a motion that is made at constant velocity and turn rate (0: none of it, 1:
/// all, 2: twice as far).
Pose2 part_of(const Pose2& motion, double share);

/// A spatial rigid transform T_a_b.
using Pose3 = Eigen::Isometry3d;

/// Right-handed rotation about an axis of unit length, with the same bits on every machine
/// (elementary.h), which Eigen's AngleAxis does not promise.
Eigen::Matrix3d rotation(double angle_rad, const Eigen::Vector3d& axis);

/// The planar transform as a spatial one: z = 0, no roll, no pitch.
Pose3 to_pose3(const Pose2& pose);

/// The planar part of a spatial transform: x, y, and the heading of its x axis. Roll, pitch and z
/// are dropped.
Pose2 to_pose2(const Pose3& pose);

/// Distance between two poses' origins in the plane (m).
double distance_m(const Pose2& a, const Pose2& b);

/// Absolute difference of two poses' headings (rad), in [0, pi].
double turn_rad(const Pose2& a, const Pose2& b);

}  // namespace voxlist
