#pragma once

#include <vector>

#include "voxlist/planning/rays/ray_window.h"

namespace voxlist::planning {

/// Adds to each old ray's `passed` the new rays that went on through where it ended. Of a wide
/// thing those count that pass within a hand's breadth, for a beam cannot; of a thin one, a chair's
/// leg, only those that would have met the very point.
void count_passes(std::vector<Ray>& old, const std::vector<Ray>& news);

/// Whether what the ray met is gone, or was never there.
bool is_refuted(const Ray& ray);

}  // namespace voxlist::planning
