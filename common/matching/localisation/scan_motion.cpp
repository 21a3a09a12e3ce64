#include "voxlist/matching/localisation/scan_motion.h"

namespace voxlist::matching {
std::optional<Pose2> scan_motion(const Cloud& before, const PreparedScan& now,
                                 const PoseWindow& window, const MatcherConfig& config,
                                 double least_inlier_ratio) {
  OccupancyMap map;
  add_scan(before, Pose3::Identity(), config.scan.max_range_m, map);
  if (map.empty()) return std::nullopt;
  const Match match = make_matcher(map, config)->match(now, window);
  if (match.modes.empty() || match.modes.front().inlier_ratio < least_inlier_ratio)
    return std::nullopt;
  return match.modes.front().pose;
}

}  // namespace voxlist::matching
