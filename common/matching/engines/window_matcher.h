#pragma once

#include <array>
#include <memory>

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

  /// As Matcher::track().
  /// The modes are not weighed yet.
  Match track(const PreparedScan& scan, const PoseWindow& window, const UncertainPose& prior);

  /// These blocks of the map have gained or lost voxels.
  void map_changed(const ChangedBlocks& changed);

 private:
  WindowMap& map_for(const PreparedScan& scan);
  SearchResult search(WindowMap& map, const PreparedScan& scan, const PoseWindow& window,
                      const SearchConfig& config) const;
  double overlap_ratio_at(WindowMap& map, const PreparedScan& scan, const Pose2& pose) const;
  double significance_log10(const WindowMap& map, const PreparedScan& scan,
                            const PoseWindow& window, const SearchResult& found) const;

  const VoxelMap& map_;
  const SurfelMap& surfels_;
  const double cell_m_;
  // Maps that were asked for; the index is how often their layers are doubled.
  std::array<std::unique_ptr<WindowMap>, WindowMap::kMostDoublings + 1> maps_;
};

}  // namespace voxlist::matching
