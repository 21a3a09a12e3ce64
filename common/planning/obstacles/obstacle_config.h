#pragma once

namespace voxlist::planning {

/// What counts as an obstacle, and how long it is remembered.
struct ObstacleConfig {
  int sectors = 360;
  double floor_z_m = 0.0;
  double min_height_m = 0.1;
  double max_height_m = 1.0;
  double step_m = 0.04;
  double max_slope_deg = 11.0;
  double rocking_deg = 0.3;
  double min_range_m = 0.3;
  double max_range_m = 10.0;
  double cell_m = 0.1;
  int min_points = 2;
  double lone_within_m = 2.0;
  double unseen_near_m = 1.5;
  double gap_m = 1.0;
  double window_s = 4.0;
  double window_without_odometry_s = 1.2;
  double memory_s = 60.0;

  template <class Visitor>
  void visit(Visitor& v) {
    v("sectors", sectors, "bearings, evenly round the robot", 1, 36'000);
    v("floor_z_m", floor_z_m,
      "height of the floor under the wheels in the cloud's frame: 0 in base", -100.0, 100.0);
    v("min_height_m", min_height_m, "above the floor: what the wheels get over, and noise", 0.0,
      100.0);
    v("max_height_m", max_height_m, "above the floor: the robot's height", 0.0, 100.0);
    v("step_m", step_m, "the wheels get down this far: a deeper drop is negative", 0.01, 1.0);
    v("max_slope_deg", max_slope_deg, "the floor may rise and fall so: ramps, and a little more",
      0.0, 45.0);
    v("rocking_deg", rocking_deg, "the robot pitches and rolls so far between two looks", 0.0,
      10.0);
    v("min_range_m", min_range_m, "horizontal: nearer points are the robot itself", 0.0, 100.0);
    v("max_range_m", max_range_m, "horizontal", 0.0, 1000.0);
    v("cell_m", cell_m, "edge of the grid's cells", 0.01, 10.0);
    v("min_points", min_points, "an obstacle has this many in its cell and the eight round it", 1,
      1000);
    v("lone_within_m", lone_within_m, "nearer than this one point is enough", 0.0, 1000.0);
    v("unseen_near_m", unseen_near_m,
      "the robot hides the floor from its scanner up to here: taken to be as under the wheels", 0.0,
      100.0);
    v("gap_m", gap_m, "confirmed floor has no unseen strip wider than this", 0.05, 10.0);
    v("window_s", window_s, "with ODOMETRY: points so old are still looked at", 0.1, 60.0);
    v("window_without_odometry_s", window_without_odometry_s,
      "without: as long as a sweep takes, or less than the robot moves a cell in", 0.1, 60.0);
    v("memory_s", memory_s, "with ODOMETRY: what no ray has looked at again is kept so long", 0.0,
      3600.0);
  }
};

}  // namespace voxlist::planning
