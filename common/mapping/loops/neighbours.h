#pragma once

#include <vector>

#include "voxlist/mapping/graph/pose_edge.h"
#include "voxlist/mapping/loops/look_memory.h"
#include "voxlist/mapping/loops/neighbour_look.h"
#include "voxlist/mapping/loops/odometry_step.h"
#include "voxlist/mapping/loops/storeys.h"

namespace voxlist::mapping {

/// The drive's own way: what joins the keyframes of a map, whose poses are about right, to a tree.
/// Each is matched with the one before, and odometry tells what the match does not, such as the way
/// along a corridor, unless it is vague itself; where a drive hangs together otherwise, the nearest
/// ones that match join its parts; and what no match joins stands as vague odometry or the map has
/// it, and is not sure of that. In the order that PoseTree wants. Looks that are `known` or in the
/// memory, where the poses say the same, are not taken again; the memory keeps the others.
std::vector<PoseEdge> join_neighbours(const std::vector<Pose2>& poses,
                                      const DriveOdometry& odometry, const ReadCloud& read,
                                      const matching::MatcherConfig& config,
                                      const KnownLook& known = {}, LookMemory* memory = nullptr,
                                      const DriveHeights& heights_m = {});

}  // namespace voxlist::mapping
