#pragma once

#include <Eigen/Core>
#include <vector>

#include "voxlist/simulation/building/box_tree.h"

namespace voxlist::simulation {

/// Size of a simulated building. Metres, inner measures. Rooms get no smaller than 2.4 m: more of
/// them, or more stairs, than fit is an std::invalid_argument. So are rooms that are alike and odd
/// in number or with stairs.
struct BuildingConfig {
  double length_m = 16.0;  ///< along the corridor
  double depth_m = 12.0;   ///< across it
  double height_m = 2.6;   ///< floor to ceiling
  double corridor_width_m = 2.2;
  int rooms = 6;                ///< alternately left and right of the corridor
  int furniture_per_room = 12;  ///< tried for; what would block the way is left out
  int seed = 1;
  int stairs = 0;  ///< flights of stairs down, each along a room's outer wall
  int pipes = 0;  ///< rooms with a pipe across a corner; with any, one under the corridor's ceiling
  int alike = 0;  ///< other than 0: one room for all, as in a hotel; the seed of that room
  int objects = 0;  ///< small things on each room's floor, by the building's seed: tried for
  int changed =
      0;  ///< other than 0: the same building, later: some furniture is moved, gone, or new
};

/// A rectangle on the floor, sides along x and y.
struct Rectangle {
  Eigen::Vector2d low, high;

  /// Horizontal distance of a point: 0 on and inside it.
  double distance_m(const Eigen::Vector2d& point) const;

  bool overlaps(const Rectangle& other) const;
};

/// A room off the corridor: its free rectangle, and the middle of its doorway.
struct Room {
  Eigen::Vector2d low, high, door;

  Eigen::Vector2d centre() const { return (low + high) / 2.0; }
};

/// A building made of boxes, in the map frame: the floor is z = 0, the corridor runs along x, and
/// the origin is in its middle line, 1 m from its end. The way from the origin through each door to
/// the middle of its room is free of furniture and holes.
struct Building {
  BoxTree solid;
  std::vector<Room> rooms;

  /// Holes in the floor: where stairs go down.
  std::vector<Rectangle> holes;

  /// Horizontal distance from a point to the nearest hole, or box that stands within a height band:
  /// the room there is for a round robot.
  double clearance_m(const Eigen::Vector2d& point, double low_m, double high_m) const;
};

/// Builds walls with doors, floor, ceiling, stairs, pipes and furniture: the same for the same
/// config, on every machine. Stairs and pipes leave walls and doors where they are.
///
/// Rooms that are alike have the same size, door and furniture, those on the right of the corridor
/// turned round, and the corridor is bare: only small objects and pipes tell one from the other.
Building make_building(const BuildingConfig& config);

}  // namespace voxlist::simulation
