#pragma once

#include <cstdint>
#include <vector>

#include "voxlist/geometry/cloud.h"
#include "voxlist/geometry/pose.h"
#include "voxlist/voxels/voxel_map.h"

namespace voxlist {

/// Edge of the cells that rays are known to have passed (m).
inline constexpr double kPassedResolution_m = 0.08;

/// The revisions of a map's two parts.
struct MapRevision {
  std::uint64_t occupied = 0, passed = 0;

  bool operator==(const MapRevision&) const = default;
};

/// What is known of the space that a robot has seen: voxels that were hit, and coarser cells that
/// rays went through. A cell with neither is unknown: no scan may be blamed for what it sees there.
struct OccupancyMap {
  VoxelMap occupied{kFinestResolution_m};
  VoxelMap passed{kPassedResolution_m};

  bool empty() const { return occupied.empty(); }

  /// Tells states of the map apart (see VoxelMap::revision).
  MapRevision revision() const { return {occupied.revision(), passed.revision()}; }
};

/// A change of a map: positions (block coordinates of each map) of blocks that changed, each once,
/// ascending, and the map's revisions before and after. What was made of the map before can tell by
/// them whether it has missed another change.
struct ChangedBlocks {
  std::vector<Voxel> occupied, passed;
  MapRevision from{}, to{};
};

/// What turns one map into another of the same resolution.
ChangedBlocks difference(const OccupancyMap& from, const OccupancyMap& to);

/// Adds a scan (in base) to a map: its points, and the way of its rays up to them. Points farther
/// than max_range_m from where their rays started are left out, ray and all, and so are those
/// outside the lattice.
ChangedBlocks add_scan(const Cloud& cloud_base, const Pose3& T_map_base, double max_range_m,
                       OccupancyMap& map);

}  // namespace voxlist
