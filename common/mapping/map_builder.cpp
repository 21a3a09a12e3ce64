#include "voxlist/mapping/map_builder.h"

#include <algorithm>
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

MapBuilder::MapBuilder(const MapBuilderConfig& config)
    : config_(config), map_({config.carve, config.min_range_m, config.max_range_m}) {}

bool MapBuilder::has_moved(const Pose2& pose) const {
  return distance_m(pose, looked_at_) >= config_.min_distance_m ||
         turn_rad(pose, looked_at_) >= config_.min_turn_deg * std::numbers::pi / 180.0;
}

bool MapBuilder::wants(const Cloud& cloud, const Pose2& pose, const Tilt& tilt) {
  if (poses_.empty()) return true;
  if (!has_moved(pose)) return false;
  looked_at_ = pose;
  return news_of({to_pose3(pose, tilt), cloud}) >= config_.min_news;
}

// How much of a scan is news: the share of cells that it hits or passes and the map does not
// know, or that of what it sees to be gone in what it hits, whichever is larger.
double MapBuilder::news_of(const CarvedMap::Scan& scan) {
  const ScanNews news = scan_news(scan.cloud, scan.T_map_base, config_.max_range_m, map());
  const double doubted = static_cast<double>(map_.count_doubted(scan));
  return std::max(news.share(), doubted / static_cast<double>(std::max<std::size_t>(news.hit, 1)));
}

void MapBuilder::clear() {
  map_.clear();
  poses_.clear();
  changed_blocks_ = {};
  looked_at_ = {};
}

Keyframe MapBuilder::add(Keyframe keyframe) {
  remove_near(keyframe.cloud, config_.min_range_m);
  changed_blocks_ = map_.add({keyframe.T_map_base, keyframe.cloud});
  looked_at_ = to_pose2(keyframe.T_map_base);
  poses_.push_back({keyframe.cloud.utime_us, keyframe.T_map_base});
  return keyframe;
}

}  // namespace voxlist::mapping
