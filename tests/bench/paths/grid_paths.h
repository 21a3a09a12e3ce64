#pragma once

#include "tests/bench/paths/path_trial.h"

namespace voxlist::bench {

/// Errands in the simulated building of a seed, with stairs down in one room, for grid_planner,
/// which hears the building's GRID alone.
PathTally plan_in_grid(int seed, int errands, const Body& body);

}  // namespace voxlist::bench
