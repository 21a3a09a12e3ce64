#pragma once

#include <functional>
#include <optional>

#include "voxlist/planning/octomap.h"
#include "voxlist/voxels/counters/ray_scratch.h"

namespace voxlist::planning {

/// Marks the rays of the clouds that `next` hands out, in up to `threads` scratches at once, and
/// gives each scratch to `count` in the order of the clouds: the same for any number of threads.
/// `next` and `count` are called by one thread at a time. False once `stopped` says yes: then the
/// clouds that were counted are the first ones.
bool mark_in_order(const std::function<std::optional<PosedCloud>()>& next, const RayRules& rules,
                   int threads, const std::function<bool()>& stopped,
                   const std::function<void(const RayScratch&)>& count);

}  // namespace voxlist::planning
