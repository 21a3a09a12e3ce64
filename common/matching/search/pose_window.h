#pragma once

#include "voxlist/geometry/pose.h"
#include "voxlist/voxels/voxel_map.h"

namespace voxlist::matching {

/// The poses to search: those within half_* of the centre, on each coordinate.
struct PoseWindow {
  Pose2 center;
  double half_x_m = 0.0;
  double half_y_m = 0.0;
  /// pi or more: every heading.
  double half_yaw_rad = 0.0;
};

/// Every pose whose origin lies over the box of the map's blocks, every heading. The origin alone
/// when the map has none.
PoseWindow whole_map(const VoxelMap& map);

}  // namespace voxlist::matching
