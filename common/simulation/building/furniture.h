#pragma once

#include <vector>

#include "voxlist/simulation/building/box_tree.h"
#include "voxlist/simulation/building/floor_plan.h"

namespace voxlist::simulation {

class Random;

/// A table, a shelf or a column, and the region that it was put into.
struct Furniture {
  Rectangle region;
  std::vector<Box> boxes;
};

/// Furniture for every room and the corridor, as many pieces as fit out of those tried for. Tables
/// stand on four legs, and their tops overhang. Rooms that are alike get copies of the first one's,
/// and the corridor nothing.
std::vector<Furniture> furnish(const FloorPlan& plan, const BuildingConfig& config, Random& random);

/// What a while later stands there: some pieces are gone, some moved within their region, and some
/// regions have a new one.
std::vector<Furniture> rearranged(std::vector<Furniture> furniture, const FloorPlan& plan,
                                  const BuildingConfig& config, Random& random);

}  // namespace voxlist::simulation
