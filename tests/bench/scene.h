#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "voxlist/geometry/pose.h"
#include "voxlist/voxels/voxel_map.h"

namespace voxlist::bench {

/// What the benchmarks work on: a map at 0.02 m, and a scan that is not part of it.
struct Scene {
  std::string name;
  VoxelMap map;
  std::vector<Eigen::Vector3f> scan;
  /// Where the scan was taken (T_map_base).
  Pose2 truth;
};

/// The hall, where the data folder has it: a map of its even scans, and an odd one. The folder is
/// VOXLIST_DATA, else
/// ../shared/data beside the sources. Otherwise a seeded synthetic room.
const Scene& scene();

}  // namespace voxlist::bench
