#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "voxlist/geometry/cloud.h"

namespace voxlist::planning {

/// What counts as an obstacle.
struct ObstacleConfig {
  int sectors = 360;
  double floor_z_m = 0.0;
  double min_height_m = 0.1;
  double max_height_m = 1.0;
  double min_range_m = 0.3;
  double max_range_m = 10.0;
  double cell_m = 0.1;
  int min_points = 2;

  template <class Visitor>
  void visit(Visitor& v) {
    v("sectors", sectors, "bearings, evenly round the robot", 1, 36'000);
    v("floor_z_m", floor_z_m, "height of the floor in the cloud's frame: 0 in base", -100.0, 100.0);
    v("min_height_m", min_height_m, "above the floor: what the wheels get over, and noise", 0.0,
      100.0);
    v("max_height_m", max_height_m, "above the floor: the robot's height", 0.0, 100.0);
    v("min_range_m", min_range_m, "horizontal: nearer points are the robot itself", 0.0, 100.0);
    v("max_range_m", max_range_m, "horizontal", 0.0, 1000.0);
    v("cell_m", cell_m, "edge of the grid's cells", 0.01, 10.0);
    v("min_points", min_points, "an obstacle has this many in its cell and the eight round it", 1,
      1000);
  }
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

}  // namespace voxlist::planning
