#pragma once

#include <vector>

#include "voxlist/mapping/graph/pose_edge.h"
#include "voxlist/mapping/loops/look_memory.h"
#include "voxlist/mapping/loops/neighbour_look.h"
#include "voxlist/mapping/loops/odometry_step.h"
#include "voxlist/mapping/loops/storeys.h"

namespace voxlist::mapping {

/// What closing a map's loops came to.
struct MapClosing {
  /// T_map_keyframe of each, rounded; as they were where nothing is to be closed.
  std::vector<Pose2> poses;
  /// Loops that were believed: looks from one keyframe at others of long before, or on the other
  /// side of a step that no match tells.
  std::size_t loops = 0;
  /// Those that agree with each other and were not believed: they would move the past by more than
  /// it may be off.
  std::size_t refused = 0;
  /// What holds the keyframes, where it was looked for: by the drive, then by loops that may be
  /// believed.
  std::vector<PoseEdge> edges;
  /// Whether keyframes are to be moved. A drive that was tracked on its own old ground is closed.
  bool moves = false;
};

/// Where keyframes, whose poses are about right, stand when the drive's loops are closed.
/// `poses`: T_map_keyframe in the order of time; the first one stays. `odometry`: of each, or
/// empty. A match for each keyframe and its neighbour and one each 2 m, 10 to 30 ms each, where the
/// drive came back or has a step of more than 10 m; next to nothing where it did not. Several
/// matches at once, on the threads of the caller's arena; `read_cloud` is asked by one at a time.
/// `known`: looks of neighbours that were taken before; `memory`: all looks that were, it keeps the
/// others. The answer is the same without them. `heights_m`: no loop joins two storeys.
MapClosing close_map(const std::vector<Pose2>& poses, const DriveOdometry& odometry,
                     const ReadCloud& read_cloud, const matching::MatcherConfig& config,
                     const KnownLook& known = {}, LookMemory* memory = nullptr,
                     const DriveHeights& heights_m = {});

}  // namespace voxlist::mapping
