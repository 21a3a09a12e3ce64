#include "voxlist/matching/localisation/scan_motion.h"

namespace voxlist::matching {

std::optional<Pose2> scan_motion(const Cloud& before, const Cloud& now, const PoseWindow& window,
                                 const MatcherConfig& config) {
  constexpr double kLeastFit = 0.3;
  OccupancyMap map;
  add_scan(before, Pose3::Identity(), config.max_range_m, map);
  if (map.empty()) return std::nullopt;
  const Match match = make_matcher(map, config)->match(now, window);
  if (match.modes.empty() || match.modes.front().fit < kLeastFit) return std::nullopt;
  return match.modes.front().pose;
}

}  // namespace voxlist::matching
