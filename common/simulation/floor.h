#pragma once

#include "simulation/building.h"

namespace voxlist {

/// A floor of several wings side by side along y, each a building of its own seed (config.seed,
/// +1, ...) with a corridor along x and rooms on both sides. There are no doors between wings: it
/// is for placing scans, not for driving through. The first wing is where make_building puts it.
Building make_floor(const BuildingConfig& wing, int wings);

}  // namespace voxlist
