#pragma once

#include <cstdint>
#include <vector>

#include "voxlist/planning/grids/ground.h"
#include "voxlist/planning/profiles/robot_profile.h"

namespace voxlist::planning {

/// What one robot can do in a cell; the numbers are those of TRAVERSABILITY messages.
enum class CellType : std::uint8_t {
  kUnknown = 0,   ///< its floor was not seen: never free
  kFree = 1,      ///< floor, and nothing up to the robot's height and clearance
  kObstacle = 2,  ///< something stands there
  kOverhang = 3,  ///< something hangs there that a lower robot passes under
  kNegative = 4,  ///< the floor drops by more than a step: a hole, stairs down, a kerb from above
};

/// The floor plan for one robot, cell by cell. It is not grown by the robot's radius: a cell is
/// free where a part of the robot may be, and a planner keeps the robot's middle its radius away
/// from what is not.
struct TypedGrid {
  CellBox box;
  std::vector<CellType> cells;  ///< row by row, x first, from the lowest x and y

  CellType at(const Cell& cell) const { return cells[box.index(cell)]; }

  bool operator==(const TypedGrid&) const = default;
};

/// How far from a cell the types of others change its own (cells): surfaces that hang go on between
/// cells that a robot does not fit between.
std::int32_t typing_margin(const RobotProfile& robot);

/// Types the cells of a box for a robot. Precondition: the ground is of these columns and the
/// robot's step, and its box holds this one and typing_margin about it, as far as there are
/// columns.
TypedGrid type_cells(const FloorColumns& columns, const Ground& ground, const RobotProfile& robot,
                     const CellBox& box);

}  // namespace voxlist::planning
