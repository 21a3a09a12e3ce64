#pragma once

#include "voxlist/planning/grids/typed_grid.h"
#include "voxlist/simulation/building/building.h"

namespace voxlist::bench {

/// What a cell is in the world.
enum class TrueCell {
  kFree,      ///< floor, and nothing within 2 cm of the cell that the robot would touch
  kObstacle,  ///< something stands in it
  kOverhang,  ///< something hangs in it, and nothing stands there
  kHole,      ///< within a hole in the floor
  kBorder,    ///< none of these: an edge grazes it
};

/// What the building has at a cell, for a robot on the floor at height 0. What is there is told on
/// points 1 cm apart that are at least 2 cm inside a box, the edge of a voxel.
TrueCell true_cell(const simulation::Building& building, const planning::Cell& cell,
                   const planning::RobotProfile& robot);

}  // namespace voxlist::bench
