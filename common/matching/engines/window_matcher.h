#pragma once

#include "voxlist/matching/counting/window_map.h"
#include "voxlist/matching/engines/matcher.h"
#include "voxlist/matching/surfaces/surfels.h"
#include "voxlist/voxels/occupancy_map.h"

namespace voxlist::matching {

/// Finds a scan within a window of poses: tracking. Counts every pose of the window's lattice, then
/// refines the best. Both maps must outlive it.
class WindowMatcher {
 public:
  WindowMatcher(const OccupancyMap& map, const SurfelMap& surfels);

  Match match(const PreparedScan& scan, const PoseWindow& window);

  /// These blocks of the map have gained voxels.
  void map_grew(const ChangedBlocks& grown) { window_map_.map_grew(grown.occupied); }

 private:
  double significance_log10(const CellRectangle& ground, std::size_t points,
                            const SearchResult& found) const;

  const SurfelMap& surfels_;
  const double cell_m_;
  WindowMap window_map_;
};

}  // namespace voxlist::matching
