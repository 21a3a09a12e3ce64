#pragma once

#include <cstddef>

#include "voxlist/geometry/cloud.h"
#include "voxlist/geometry/pose.h"
#include "voxlist/voxels/occupancy_map.h"

namespace voxlist {

/// What a scan would tell a map, in cells of the size of `passed`: how many it hits and its rays
/// pass, and how many of these are news. A hit is news where the map has no hit in the cell: it was
/// unknown, or known to be free. A pass is news where no ray went through before: the cell was
/// unknown, or held something that is gone or that the scan sees past.
struct ScanNews {
  std::size_t hit = 0, newly_hit = 0;
  std::size_t passed = 0, newly_passed = 0;

  /// The larger of the two shares, 0 to 1. Adding the scan to the map makes it 0.
  double share() const;
};

/// Adds what the hit and passed cells of one block of a scan tell. Precondition as scan_news().
void add_news(const Voxel& block, const VoxelBlock& hit, const VoxelBlock& passed,
              const OccupancyMap& map, ScanNews& news);

/// Precondition: an edge of `passed` is 1, 2, 4 or 8 edges of `occupied`. Costs about what add_scan
/// does.
ScanNews scan_news(const Cloud& cloud_base, const Pose3& T_map_base, double max_range_m,
                   const OccupancyMap& map);

}  // namespace voxlist
