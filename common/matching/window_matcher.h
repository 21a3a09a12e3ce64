#pragma once

#include <optional>

#include "matching/matcher.h"
#include "matching/surfels.h"
#include "voxels/occupancy_map.h"

namespace voxlist {

/// Finds a scan within a window of poses: tracking. Both maps must outlive it.
class WindowMatcher {
 public:
  WindowMatcher(const OccupancyMap& map, const SurfelMap& surfels, const MatcherConfig& config);

  Match match(const Cloud& scan, const PoseWindow& window);

 private:
  double overlap_at(const Pose2& pose, const MatchPoints& scan) const;

  const OccupancyMap& map_;
  const SurfelMap& surfels_;
  const MatcherConfig config_;
  std::optional<SearchMap> window_map_;
};

}  // namespace voxlist
