#pragma once

#include <vector>

#include "voxlist/scanner/sweep/scanner_geometry.h"

namespace voxlist::scanner {

/// Settings of the cloud assembler.
struct CloudAssemblerConfig {
  ScannerGeometry geometry;
  int mirror_sides = 2;
  bool staircase = false;
  double mirror_extrapolation_ms = 50.0;
  bool use_odometry = true;
  double odometry_extrapolation_ms = 150.0;
  double max_wait_ms = 200.0;
  int max_waiting_lines = 30;
  double lines_per_s = 75.0;
  int lines_per_slice = 5;
  double sweep_boundary_deg = 0.0;
  double min_line_share = 0.5;
  double beam_first_deg = 25.0;
  double beam_last_deg = 155.0;
  std::vector<double> blind_phi_deg{-15.0, 15.0};
  std::vector<double> robot_boxes_m;
  double range_min_m = 0.3;
  double range_max_m = 80.0;

  template <class Visitor>
  void visit(Visitor& v) {
    geometry.visit(v);
    v("mirror_sides", mirror_sides, "that reflect; with 1 the other half turn gives no cloud", 1,
      2);
    v("staircase", staircase,
      "the mirror stands still between the motor's steps; else it turns evenly");
    v("mirror_extrapolation_ms", mirror_extrapolation_ms,
      "how long the mirror is trusted to turn on as MIRROR last said", 20.0, 1000.0);
    v("use_odometry", use_odometry,
      "put each beam where the robot was then; false: for a robot that stands, or has no ODOMETRY");
    v("odometry_extrapolation_ms", odometry_extrapolation_ms,
      "how long the robot is trusted to move on at ODOMETRY's last velocity", 0.0, 1000.0);
    v("max_wait_ms", max_wait_ms,
      "how long a line may wait for its mirror angle and odometry, then it is dropped", 0.0,
      1000.0);
    v("max_waiting_lines", max_waiting_lines, "beyond that the oldest is dropped", 1, 1000);
    v("lines_per_s", lines_per_s,
      "that LASER brings when none is lost: 75, fewer on a slow serial line", 1.0, 75.0);
    v("lines_per_slice", lines_per_slice, "of CLOUD_SLICE: 5 are 15 slices a second", 1, 1000);
    v("sweep_boundary_deg", sweep_boundary_deg,
      "phi where one CLOUD ends and the next begins; 0 is straight up, where the beam is blind",
      -360.0, 360.0);
    v("min_line_share", min_line_share,
      "of a sweep's lines: with fewer its CLOUD is dropped. What is missing is not seen, never "
      "taken to be free",
      0.0, 1.0);
    v("beam_first_deg", beam_first_deg, "first beam that meets the mirror, on the laser's scale",
      0.0, 180.0);
    v("beam_last_deg", beam_last_deg, "last beam that meets the mirror, on the laser's scale", 0.0,
      180.0);
    v("blind_phi_deg", blind_phi_deg,
      "pairs from, to: directions about the mirror's axis that are left out; 0 is straight up, "
      "90 is backwards",
      -360.0, 720.0);
    v("robot_boxes_m", robot_boxes_m,
      "the robot's own body, left out: boxes in base, each x from, x to, y from, y to, z from, z "
      "to",
      -100.0, 100.0);
    v("range_min_m", range_min_m, "from the mirror: nearer points are left out", 0.0, 100.0);
    v("range_max_m", range_max_m, "from the mirror: farther points are left out", 0.0, 1000.0);
  }
};

}  // namespace voxlist::scanner
