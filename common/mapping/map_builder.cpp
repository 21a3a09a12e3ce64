#include "voxlist/mapping/map_builder.h"

#include <limits>
#include <numbers>

#include "voxlist/geometry/range.h"
#include "voxlist/voxels/scan_news.h"

namespace voxlist::mapping {
namespace {

void remove_near(Cloud& cloud, double min_range_m) {
  constexpr double kAny_m = std::numeric_limits<double>::infinity();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    if (!is_within(cloud, i, min_range_m, kAny_m)) continue;
    cloud.points[kept] = cloud.points[i];
    if (!cloud.origins.empty()) cloud.origins[kept] = cloud.origins[i];
    ++kept;
  }
  cloud.points.resize(kept);
  if (!cloud.origins.empty()) cloud.origins.resize(kept);
}

}  // namespace

bool MapBuilder::has_moved(const Pose2& pose) const {
  return distance_m(pose, looked_at_) >= config_.min_distance_m ||
         turn_rad(pose, looked_at_) >= config_.min_turn_deg * std::numbers::pi / 180.0;
}

bool MapBuilder::wants(const Cloud& cloud, const Pose2& pose, const Tilt& tilt) {
  if (poses_.empty()) return true;
  if (!has_moved(pose)) return false;
  looked_at_ = pose;
  return scan_news(cloud, to_pose3(pose, tilt), config_.max_range_m, map_).share() >=
         config_.min_news;
}

void MapBuilder::clear() {
  map_ = {};
  poses_.clear();
  changed_blocks_ = {};
  looked_at_ = {};
}

Keyframe MapBuilder::add(Keyframe keyframe) {
  remove_near(keyframe.cloud, config_.min_range_m);
  changed_blocks_ = add_scan(keyframe.cloud, keyframe.T_map_base, config_.max_range_m, map_);
  looked_at_ = to_pose2(keyframe.T_map_base);
  poses_.push_back({keyframe.cloud.utime_us, keyframe.T_map_base});
  return keyframe;
}

}  // namespace voxlist::mapping
