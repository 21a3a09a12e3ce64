#pragma once

#include <vector>

#include "voxlist/mapping/graph/loop_choice.h"
#include "voxlist/mapping/loops/local_map.h"
#include "voxlist/mapping/loops/look_memory.h"
#include "voxlist/mapping/loops/storeys.h"

namespace voxlist::mapping {

/// Whether a drive that went so far from one place to another, which is so far away, came round to
/// it: there it may meet ground that it mapped long before.
bool is_long_way(double way_m, double away_m);

/// Looks where a drive meets ground that it mapped long before, or before a step that no match
/// tells: each keyframe that may see such ground is searched for round where the drive has it, in a
/// map of those keyframes only, and of its own floor.
/// Matched with a map that has both, it would be held where it is by what it saw just before.
/// What the memory knows is not searched for again; it keeps the rest.
std::vector<Loop> find_loops(const PoseTree& tree, const ReadCloud& read,
                             const matching::MatcherConfig& config, LookMemory* memory = nullptr,
                             const DriveHeights& heights_m = {});

}  // namespace voxlist::mapping
