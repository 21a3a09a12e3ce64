#include "mapping/map_builder.h"

#include <numbers>
#include <set>

namespace voxlist {

bool MapBuilder::wants(const Pose2& pose) const {
  if (keyframes_.empty()) return true;
  const Pose2 last = to_pose2(keyframes_.back().T_map_base);
  return distance_m(pose, last) >= config_.min_distance_m ||
         turn_rad(pose, last) >= config_.min_turn_deg * std::numbers::pi / 180.0;
}

void MapBuilder::add(Keyframe keyframe) {
  std::set<Voxel> changed;
  const auto& points = keyframe.cloud.points;
  const auto max_range = static_cast<float>(config_.max_range_m);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if ((points[i] - keyframe.cloud.origin(i)).norm() > max_range) continue;
    const Eigen::Vector3d p = keyframe.T_map_base * points[i].cast<double>();
    if (!in_lattice(p, map_.resolution_m())) continue;
    const Voxel voxel = voxel_at(p, map_.resolution_m());
    if (map_.insert(voxel)) changed.insert(block_of(voxel));
  }
  changed_blocks_.assign(changed.begin(), changed.end());
  keyframes_.push_back(std::move(keyframe));
}

}  // namespace voxlist
