#pragma once

#include <vector>

#include "voxlist/simulation/building/floor_plan.h"
#include "voxlist/simulation/building/furniture.h"

namespace voxlist::simulation {

class Random;

/// Small things for every room, as large as a bin or a suitcase: they stand on the floor beside the
/// furniture and in nobody's way. Fewer than `per_room` where there is no place.
std::vector<Box> place_objects(const FloorPlan& plan, const std::vector<Furniture>& furniture,
                               int per_room, Random& random);

}  // namespace voxlist::simulation
