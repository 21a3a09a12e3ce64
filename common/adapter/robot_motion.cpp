#include "voxlist/adapter/robot_motion.h"

#include <algorithm>

namespace voxlist::adapter {
namespace {

constexpr auto kIsBefore = [](std::int64_t utime_us, const auto& tilt) {
  return utime_us < tilt.utime_us;
};

}  // namespace

void RobotMotion::add(const StampedPose3& T_odom_base) {
  const std::int64_t utime_us = T_odom_base.utime_us;
  plane_.add({utime_us, to_pose2(T_odom_base.pose)});
  if (!tilts_.empty() && tilts_.back().utime_us - utime_us > OdometryBuffer::kMaxAge_us)
    tilts_.clear();
  const Eigen::Matrix3d turn =
      levelled(T_odom_base.pose).linear().transpose() * T_odom_base.pose.linear();
  tilts_.insert(std::upper_bound(tilts_.begin(), tilts_.end(), utime_us, kIsBefore),
                {utime_us, T_odom_base.pose.translation().z(), Eigen::Quaterniond(turn)});
  if (tilts_.size() > OdometryBuffer::kCapacity) tilts_.pop_front();
}

std::optional<Pose3> RobotMotion::at(std::int64_t utime_us,
                                     std::int64_t max_extrapolation_us) const {
  const auto plane = plane_.estimate(utime_us, max_extrapolation_us);
  if (!plane) return std::nullopt;
  const Tilt tilt = tilt_at(utime_us);
  Pose3 T_odom_base = to_pose3(*plane);
  T_odom_base.linear() *= tilt.turn.toRotationMatrix();
  T_odom_base.translation().z() = tilt.z_m;
  return T_odom_base;
}

RobotMotion::Tilt RobotMotion::tilt_at(std::int64_t utime_us) const {
  const auto later = std::upper_bound(tilts_.begin(), tilts_.end(), utime_us, kIsBefore);
  if (later == tilts_.end()) return tilts_.back();
  if (later == tilts_.begin()) return tilts_.front();
  const Tilt &a = *std::prev(later), &b = *later;
  const double share =
      static_cast<double>(utime_us - a.utime_us) / static_cast<double>(b.utime_us - a.utime_us);
  // Tilts are small and near each other, so the chord between them is as good as the arc.
  const double sign = a.turn.dot(b.turn) < 0.0 ? -1.0 : 1.0;
  const Eigen::Vector4d chord = (1.0 - share) * a.turn.coeffs() + share * sign * b.turn.coeffs();
  return {utime_us, a.z_m + share * (b.z_m - a.z_m), Eigen::Quaterniond(chord).normalized()};
}

Pose3 levelled(const Pose3& T_odom_base) {
  Pose3 level = to_pose3(to_pose2(T_odom_base));
  level.translation().z() = T_odom_base.translation().z();
  return level;
}

}  // namespace voxlist::adapter
