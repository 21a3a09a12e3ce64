#include "voxlist/geometry/pose.h"

#include <cmath>
#include <numbers>

#include "voxlist/geometry/elementary.h"

namespace voxlist {

double wrap_angle(double angle_rad) {
  const double wrapped = std::remainder(angle_rad, 2.0 * std::numbers::pi);
  return wrapped == -std::numbers::pi ? std::numbers::pi : wrapped;
}

Pose2 Pose2::operator*(const Pose2& T_b_c) const {
  const auto [s, c] = elementary::sine_cosine(yaw_rad);
  return {x_m + c * T_b_c.x_m - s * T_b_c.y_m, y_m + s * T_b_c.x_m + c * T_b_c.y_m,
          wrap_angle(yaw_rad + T_b_c.yaw_rad)};
}

Pose2 Pose2::inverse() const {
  const auto [s, c] = elementary::sine_cosine(yaw_rad);
  return {-c * x_m - s * y_m, s * x_m - c * y_m, wrap_angle(-yaw_rad)};
}

Eigen::Vector3d Pose2::operator*(const Eigen::Vector3d& p_b) const {
  const auto [s, c] = elementary::sine_cosine(yaw_rad);
  return {x_m + c * p_b.x() - s * p_b.y(), y_m + s * p_b.x() + c * p_b.y(), p_b.z()};
}

Pose2 part_of(const Pose2& motion, double share) {
  // An arc's chord is as long as the sine of half its turn, and points half its turn inwards.
  const double half_rad = motion.yaw_rad / 2.0;
  const double length = std::abs(half_rad) < 1e-6
                            ? share
                            : elementary::sin(share * half_rad) / elementary::sin(half_rad);
  const Pose2 inwards{0.0, 0.0, (share - 1.0) * half_rad};
  const Pose2 chord = inwards * Pose2{length * motion.x_m, length * motion.y_m, 0.0};
  return {chord.x_m, chord.y_m, wrap_angle(share * motion.yaw_rad)};
}

Eigen::Matrix3d rotation(double angle_rad, const Eigen::Vector3d& axis) {
  // Rodrigues: R = cos I + sin [a]x + (1 - cos) a a'.
  const auto [s, c] = elementary::sine_cosine(angle_rad);
  const Eigen::Vector3d sine = s * axis, rest = (1.0 - c) * axis;
  const double xy = rest.x() * axis.y(), yz = rest.y() * axis.z(), zx = rest.z() * axis.x();
  Eigen::Matrix3d R;
  R << c + rest.x() * axis.x(), xy - sine.z(), zx + sine.y(),  //
      xy + sine.z(), c + rest.y() * axis.y(), yz - sine.x(),   //
      zx - sine.y(), yz + sine.x(), c + rest.z() * axis.z();
  return R;
}

Pose3 to_pose3(const Pose2& pose) {
  Pose3 T = Pose3::Identity();
  T.translation() << pose.x_m, pose.y_m, 0.0;
  T.linear() = rotation(pose.yaw_rad, Eigen::Vector3d::UnitZ());
  return T;
}

Pose2 to_pose2(const Pose3& pose) {
  const auto& R = pose.linear();
  return {pose.translation().x(), pose.translation().y(), elementary::atan2(R(1, 0), R(0, 0))};
}

double distance_m(const Pose2& a, const Pose2& b) {
  return elementary::hypot(a.x_m - b.x_m, a.y_m - b.y_m);
}

double turn_rad(const Pose2& a, const Pose2& b) {
  return std::abs(wrap_angle(a.yaw_rad - b.yaw_rad));
}

}  // namespace voxlist
