#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulation/box_tree.h"

namespace voxlist {

/// Size of a simulated building. Metres, inner measures. Rooms get no smaller than 2.4 m: more of
/// them than fit is an std::invalid_argument.
struct BuildingConfig {
  double length_m = 16.0;  ///< along the corridor
  double depth_m = 12.0;   ///< across it
  double height_m = 2.6;   ///< floor to ceiling
  double corridor_width_m = 2.2;
  int rooms = 6;                ///< alternately left and right of the corridor
  int furniture_per_room = 12;  ///< tried for; what would block the way is left out
  int seed = 1;
};

/// A room off the corridor: its free rectangle, and the middle of its doorway.
struct Room {
  Eigen::Vector2d low, high, door;

  Eigen::Vector2d centre() const { return (low + high) / 2.0; }
};

/// A building made of boxes, in the map frame: the floor is z = 0, the corridor runs along x, and
/// the origin is in its middle line, 1 m from its end. The way from the origin through each door to
/// the middle of its room is free of furniture.
struct Building {
  BoxTree solid;
  std::vector<Room> rooms;

  /// Horizontal distance from a point to the nearest box that stands within a height band: the room
  /// there is for a round robot.
  double clearance_m(const Eigen::Vector2d& point, double low_m, double high_m) const;
};

/// Builds walls with doors, floor, ceiling, and furniture: the same for the same config, on every
/// machine.
Building make_building(const BuildingConfig& config);

}  // namespace voxlist
