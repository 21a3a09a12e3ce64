#pragma once

#include <Eigen/Core>
#include <vector>

#include "voxlist/simulation/building/box_tree.h"
#include "voxlist/simulation/building/building.h"

namespace voxlist::simulation {

class Random;

/// Thickness of walls, floor and ceiling, metres.
inline constexpr double kWall_m = 0.12;

/// Half the width of every way, which is kept free of whatever stands on the floor, metres.
inline constexpr double kWayHalfWidth_m = 0.5;

/// A building in the making: walls and what must stay free.
struct FloorPlan {
  Rectangle inside;        ///< of the outer walls
  std::vector<Box> boxes;  ///< the first is the floor
  std::vector<Room> rooms;
  std::vector<Eigen::Vector2d> ways;  ///< points along them, 0.1 m apart
  std::vector<Rectangle> holes;

  /// Whether something with this footprint lies within the region (with less than a hair's slack)
  /// and blocks neither way nor hole.
  bool leaves_room_for(const Box& box, const Rectangle& region) const;
};

/// A solid block between two corners.
Box block(const Eigen::Vector3d& low, const Eigen::Vector3d& high);

/// A box that stands on the floor.
Box standing(const Eigen::Vector2d& centre, const Eigen::Vector3d& size, double yaw_rad = 0.0);

/// The smallest rectangle, sides along x and y, over which a box stands.
Rectangle footprint(const Box& box);

/// Outer walls, floor, ceiling, and rooms with doors on both sides of a corridor.
FloorPlan make_floor_plan(const BuildingConfig& config, Random& random);

}  // namespace voxlist::simulation
