#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "geometry/cloud.h"

namespace voxlist {

/// What counts as an obstacle.
struct ObstacleConfig {
  int sectors = 360;          ///< bearings, evenly round the robot
  double floor_z_m = 0.0;     ///< height of the floor in the cloud's frame: 0 in base
  double min_height_m = 0.1;  ///< above the floor: what the wheels get over, and the floor's noise
  double max_height_m = 1.0;  ///< above the floor: the robot's height
  double min_range_m = 0.3;   ///< horizontal: nearer points are the robot itself
  double max_range_m = 10.0;  ///< horizontal
  double cell_m = 0.1;        ///< of the grid that points support each other on
  int min_points = 2;         ///< an obstacle has this many in its cell and the eight round it
};

/// The nearest obstacle in each bearing, in the cloud's frame.
struct ObstacleScan {
  std::int64_t utime_us = 0;

  /// Sector i is centred on bearing i * step_rad, counter-clockwise from forward (+x).
  double step_rad = 0.0;

  /// Horizontal distance from the frame's origin to the nearest obstacle of each sector; infinity:
  /// none seen.
  std::vector<float> ranges_m;

  /// Centres of the grid's cells that hold an obstacle, ordered by x, then y.
  std::vector<Eigen::Vector2f> cells_m;
};

/// Finds the obstacles of a cloud. A lone point is taken for noise: single echoes of far and thin
/// things are missed until they are near enough to be hit twice.
ObstacleScan nearest_obstacles(const Cloud& cloud_base, const ObstacleConfig& config);

}  // namespace voxlist
