#include "services/mapper/travelled_path.h"

#include <algorithm>

#include "voxlist/mapping/pieces/carried_scans.h"

namespace voxlist::services {

StampedPose3 TravelledPath::Entry::in_3d() const {
  return {pose.utime_us, to_pose3(pose.pose, tilt)};
}

void TravelledPath::add(const StampedPose2& pose, const Tilt& tilt) {
  newest_.push_back({pose, tilt});
  if (newest_.size() <= kNewest) return;
  if (newest_.front().is_keyframe) old_keyframes_.push_back(newest_.front().in_3d());
  newest_.pop_front();
}

void TravelledPath::move(std::span<const StampedPose3> before,
                         std::span<const StampedPose3> after) {
  mapping::carry_scans(old_keyframes_, before, after);
  std::vector<StampedPose3> scans;
  for (const Entry& entry : newest_) scans.push_back(entry.in_3d());
  mapping::carry_scans(scans, before, after);
  for (std::size_t i = 0; i < scans.size(); ++i) newest_[i].pose.pose = to_pose2(scans[i].pose);
}

std::vector<StampedPose3> TravelledPath::poses() const {
  std::vector<StampedPose3> poses = old_keyframes_;
  for (const Entry& entry : newest_) poses.push_back(entry.in_3d());
  std::ranges::stable_sort(poses, {}, &StampedPose3::utime_us);
  return poses;
}

}  // namespace voxlist::services
