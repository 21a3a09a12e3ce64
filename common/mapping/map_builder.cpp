#include "voxlist/mapping/map_builder.h"

#include <numbers>

namespace voxlist::mapping {

bool MapBuilder::wants(const Pose2& pose) const {
  if (keyframes_.empty()) return true;
  const Pose2 last = to_pose2(keyframes_.back().T_map_base);
  return distance_m(pose, last) >= config_.min_distance_m ||
         turn_rad(pose, last) >= config_.min_turn_deg * std::numbers::pi / 180.0;
}

void MapBuilder::add(Keyframe keyframe) {
  changed_blocks_ = add_scan(keyframe.cloud, keyframe.T_map_base, config_.max_range_m, map_);
  keyframes_.push_back(std::move(keyframe));
}

}  // namespace voxlist::mapping
