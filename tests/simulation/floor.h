#pragma once

#include "voxlist/simulation/building/building.h"

namespace voxlist::simulation {

/// A floor of several wings side by side along y, each a building of its own seed (config.seed,
/// +1, ...) with a corridor along x and rooms on both sides; rooms that are alike are so in all
/// wings. There are no doors between wings: one can drive within a wing. The first wing is where
/// make_building puts it.
Building make_floor(const BuildingConfig& wing, int wings);

/// From one wing's corridor to the next one's, along y (m).
double wing_pitch_m(const BuildingConfig& wing);

}  // namespace voxlist::simulation
