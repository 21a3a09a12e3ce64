#pragma once

#include "tests/bench/paths/path_trial.h"

namespace voxlist::bench {

/// Errands in the simulated building of a seed for octomap_planner, which has the building's
/// map.bt of 0.05 m alone.
PathTally plan_in_octomap(int seed, int errands, const Body& body);

}  // namespace voxlist::bench
