#include "services/mapper/travelled_path.h"

namespace voxlist::services {
namespace {

StampedPose3 in_3d(const StampedPose2& pose) { return {pose.utime_us, to_pose3(pose.pose)}; }

}  // namespace

void TravelledPath::add(const StampedPose2& pose) {
  newest_.push_back({pose});
  if (newest_.size() <= kNewest) return;
  if (newest_.front().is_keyframe) old_keyframes_.push_back(in_3d(newest_.front().pose));
  newest_.pop_front();
}

std::vector<StampedPose3> TravelledPath::poses() const {
  std::vector<StampedPose3> poses = old_keyframes_;
  for (const Entry& entry : newest_) poses.push_back(in_3d(entry.pose));
  return poses;
}

}  // namespace voxlist::services
