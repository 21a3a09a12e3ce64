#pragma once

#include <vector>

#include "services/voxlist/report/measured/scene.h"
#include "voxlist/matching/paper/particle_filter.h"

namespace voxlist::desk {

/// A map made of a scene's tour by matching alone, and where its scans were put.
struct MatchedMap {
  OccupancyMap map;
  std::vector<Pose2> poses;
  std::vector<double> errors_m;  ///< of each scan after the first, which is at the origin
};

/// By the paper's filter: each scan is searched for round where odometry has it (0.3 m, 9 deg
/// about it), down to 0.02 m times `final_factor`, in the map of those before.
MatchedMap map_by_filter(const std::vector<PlacedScan>& tour, int final_factor, int seed);

/// By Voxlist's localiser, with the same odometry. The map holds the scans that it was sure of.
MatchedMap map_by_localiser(const std::vector<PlacedScan>& tour, int seed);

/// What odometry says between scans: the true motion with errors of 0.05 m and 1 deg a step
/// (standard deviations), one pose for each scan.
std::vector<Pose2> odometry_of(const std::vector<PlacedScan>& tour, int seed);

/// A scan by a mirror whose plate gives way by 0.33 deg times the sine of its angle: 0.07 m at 6 m,
/// the paper's systematic error.
Cloud flexed(Cloud scan);

}  // namespace voxlist::desk
