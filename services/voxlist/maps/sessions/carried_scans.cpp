#include "services/voxlist/maps/sessions/carried_scans.h"

#include <algorithm>
#include <cstdlib>

namespace voxlist::desk {
namespace {

std::size_t keyframe_beside(const StampedPose3& scan, std::span<const StampedPose3> keyframes) {
  const auto away = [&](const StampedPose3& keyframe) {
    return std::pair(std::abs(keyframe.utime_us - scan.utime_us),
                     (keyframe.pose.translation() - scan.pose.translation()).squaredNorm());
  };
  const auto nearest =
      std::min_element(keyframes.begin(), keyframes.end(),
                       [&](const auto& a, const auto& b) { return away(a) < away(b); });
  return static_cast<std::size_t>(nearest - keyframes.begin());
}

}  // namespace

void carry_scans(std::span<StampedPose3> scans, std::span<const StampedPose3> before,
                 std::span<const StampedPose3> after) {
  for (StampedPose3& scan : scans) {
    const std::size_t i = keyframe_beside(scan, before);
    scan.pose = after[i].pose * before[i].pose.inverse() * scan.pose;
  }
}

}  // namespace voxlist::desk
