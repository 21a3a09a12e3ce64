#pragma once

#include <span>
#include <vector>

#include "voxlist/mapping/graph/loop_choice.h"

namespace voxlist::mapping {

/// A drive whose loops are closed.
struct ClosedDrive {
  /// T_map_keyframe of each; by the drive alone where no loop could be believed.
  std::vector<Pose2> poses;
  /// The loops that were believed.
  std::vector<Loop> loops;
  /// Those that agree with each other, but would move the past by more than it may be off.
  std::vector<Loop> refused;
};

/// Chooses the loops that may be believed and solves the poses with them; then drops loops that the
/// solved poses do not agree with. `drive`: what joins the tree's keyframes, in any order. The
/// first keyframe stays at `first`.
ClosedDrive close_loops(const PoseTree& tree, std::span<const PoseEdge> drive,
                        std::span<const Loop> loops, const Pose2& first = {});

}  // namespace voxlist::mapping
