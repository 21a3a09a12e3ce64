#pragma once

#include "voxlist/mapping/map_builder.h"
#include "voxlist/simulation/building/building.h"

namespace voxlist::bench {

/// A building with tables, pipes, stairs down and half-open shutters, and the map that a mirror
/// scanner makes of it from true poses, on one lap through all rooms.
struct GridScene {
  simulation::Building building;
  mapping::MapBuilder map;
};

/// A floor of 16 x 13 m with four rooms. Equal seeds give equal bits.
GridScene grid_scene(int seed);

}  // namespace voxlist::bench
