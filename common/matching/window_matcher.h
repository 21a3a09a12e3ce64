#pragma once

#include "matching/matcher.h"
#include "matching/surfels.h"
#include "matching/window_map.h"
#include "voxels/occupancy_map.h"

namespace voxlist {

/// Finds a scan within a window of poses: tracking. Counts every pose of the window's lattice, then
/// refines the best. Both maps must outlive it.
class WindowMatcher {
 public:
  WindowMatcher(const OccupancyMap& map, const SurfelMap& surfels, const MatcherConfig& config);

  Match match(const Cloud& scan, const PoseWindow& window);

  /// These blocks of the map have gained voxels.
  void map_grew(const ChangedBlocks& grown) { window_map_.map_grew(grown.occupied); }

 private:
  const SurfelMap& surfels_;
  const MatcherConfig config_;
  const double cell_m_;
  WindowMap window_map_;
};

}  // namespace voxlist
