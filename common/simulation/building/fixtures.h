#pragma once

#include "voxlist/simulation/building/floor_plan.h"

namespace voxlist::simulation {

class Random;

/// Cuts holes into the floor, each with stairs down along a room's outer wall, clear of the ways.
/// Throws std::invalid_argument when there is no place for one.
void add_stairs(FloorPlan& plan, int count, Random& random);

/// A pipe across a corner of each of `count` rooms (of all, if there are fewer), 1.2 to 1.6 m above
/// the floor, and one that hangs under the corridor's ceiling.
void add_pipes(FloorPlan& plan, const BuildingConfig& config, Random& random);

}  // namespace voxlist::simulation
