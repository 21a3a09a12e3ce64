#include "geometry/odometry_buffer.h"

#include <algorithm>

namespace voxlist {
namespace {

constexpr auto kIsBefore = [](std::int64_t utime_us, const StampedPose2& pose) {
  return utime_us < pose.utime_us;
};

}  // namespace

void OdometryBuffer::add(const StampedPose2& T_odom_base) {
  if (!poses_.empty() && poses_.back().utime_us - T_odom_base.utime_us > kMaxAge_us) poses_.clear();
  const auto later =
      std::upper_bound(poses_.begin(), poses_.end(), T_odom_base.utime_us, kIsBefore);
  poses_.insert(later, T_odom_base);
  if (poses_.size() > kCapacity) poses_.pop_front();
}

std::optional<Pose2> OdometryBuffer::at(std::int64_t utime_us) const {
  const auto later = std::upper_bound(poses_.begin(), poses_.end(), utime_us, kIsBefore);
  if (later == poses_.begin()) return std::nullopt;
  const StampedPose2& latest = *std::prev(later);
  if (utime_us - latest.utime_us > kMaxAge_us) return std::nullopt;
  return latest.pose;
}

}  // namespace voxlist
