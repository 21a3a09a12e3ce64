#pragma once

#include <vector>

#include "services/voxlist/report/measured/scene.h"
#include "voxlist/matching/paper/significance.h"
#include "voxlist/voxels/voxel_map.h"

namespace voxlist::desk {

/// Overlaps of one scan at poses that are wrong, at one resolution.
struct ChanceLevel {
  double resolution_m = 0.0;
  matching::ChanceModel model;   ///< section IV: V, N, n
  std::vector<double> overlaps;  ///< one for each pose
  int true_overlap = 0;          ///< at the true pose
};

/// Counts a scan's overlaps at poses drawn evenly over the box of a map, any heading, those within
/// a metre of the truth left out: at 0.02 to 1.28 m, finest first. `count` poses, the same for all
/// resolutions. The map's volume is that of its box.
std::vector<ChanceLevel> wrong_overlaps(const VoxelMap& map, const PlacedScan& scan, int count,
                                        int seed);

/// Between floor and ceiling of a scene (m).
inline constexpr double kBandLow_m = 0.15, kBandHigh_m = 2.45;

/// Only what lies between these heights (m), of a scan and of a map: neither floor nor ceiling.
PlacedScan band_of(const PlacedScan& scan, double low_m, double high_m);
VoxelMap band_of(const VoxelMap& map, double low_m, double high_m);

}  // namespace voxlist::desk
