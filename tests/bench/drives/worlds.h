#pragma once

#include "voxlist/simulation/building/building.h"

namespace voxlist::bench {

/// A bare corridor of 200 m, 2.2 m wide: between its ends no scan tells how far along it is.
simulation::Building bare_corridor();

/// The same with open doors of empty rooms on both sides, 3 to 4 m apart.
simulation::Building corridor_with_doors(int seed);

/// A street along x, 120 m long: fronts of houses that stand more or less back, cars, poles.
simulation::Building street(int seed);

}  // namespace voxlist::bench
