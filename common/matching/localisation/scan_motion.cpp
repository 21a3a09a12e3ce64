#include "voxlist/matching/localisation/scan_motion.h"

namespace voxlist::matching {
namespace {

// Two scans of one place, taken within seconds, lie on each other's surfaces with more than this
// share of their points; fewer do where something hides what was seen before. Chosen by judgement.
constexpr double kLeastInlierRatio = 0.3;

}  // namespace

std::optional<Pose2> scan_motion(const Cloud& before, const PreparedScan& now,
                                 const PoseWindow& window, const MatcherConfig& config) {
  OccupancyMap map;
  add_scan(before, Pose3::Identity(), config.scan.max_range_m, map);
  if (map.empty()) return std::nullopt;
  const Match match = make_matcher(map, config)->match(now, window);
  if (match.modes.empty() || match.modes.front().inlier_ratio < kLeastInlierRatio)
    return std::nullopt;
  return match.modes.front().pose;
}

}  // namespace voxlist::matching
