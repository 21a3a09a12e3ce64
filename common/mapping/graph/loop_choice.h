#pragma once

#include <span>
#include <vector>

#include "voxlist/mapping/graph/pose_tree.h"

namespace voxlist::mapping {

/// Where one look, the search for a scan among old keyframes, may have found it: one edge for each
/// place that it names, of which one at most is right.
struct Loop {
  PoseEdge edge;
  /// Places of the same look have the same number.
  std::size_t look = 0;
  /// That the scan was taken there, by what it shows alone.
  double probability = 1.0;
};

/// The loops that may be believed, in their order, one at most of each look. A wrong one is worse
/// than none, and what looks alike in one place looks alike in others, so one is never believed by
/// itself: the drive's own way must allow it, and most of the looks nearby must close a ring with
/// it.
std::vector<Loop> choose_loops(const PoseTree& tree, std::span<const Loop> loops);

/// Loops that agree with each other as those do, although the drive's own way does not allow them:
/// either it errs by more than it says, or there are two places that look alike.
std::vector<Loop> refused_loops(const PoseTree& tree, std::span<const Loop> loops);

/// Those of the chosen loops that a solved graph agrees with, if they are still enough of them to
/// be believed.
std::vector<Loop> keep_fitting(const PoseTree& tree, const std::vector<Pose2>& solved,
                               std::span<const Loop> loops);

}  // namespace voxlist::mapping
