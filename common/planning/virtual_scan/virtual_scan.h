#pragma once

#include <cstdint>
#include <vector>

#include "voxlist/geometry/cloud.h"
#include "voxlist/planning/profiles/robot_profile.h"

namespace voxlist::planning {

/// Which points of a cloud a virtual scan is made of.
struct ScanBand {
  /// Heights above the floor (z = 0 of base) that the robot takes up: from what its wheels get over
  /// to its highest part.
  double low_m = 0.03, high_m = 1.25;
  /// The furthest points are looked for up to here, or to high_m where that is higher: over the
  /// heads of people and most furniture, and below lintels and ceilings, which are no walls.
  double furthest_high_m = 2.0;
  /// Nearer points (horizontally) are the robot itself.
  double min_range_m = 0.3;
  /// Evenly round the robot.
  int bearings = 720;
};

/// What this robot's body takes up.
ScanBand band_of(const RobotProfile& robot);

/// Horizontal ranges from base's origin, by bearing: +infinity where rays went through the heights
/// and hit nothing in them, NaN where none did. Nothing seen is not free: a ray may have passed
/// above a thing, or ended on the floor before it.
struct VirtualScan {
  std::int64_t utime_us = 0;
  /// Bearing i is about i * step_rad, counter-clockwise from forward (+x).
  double step_rad = 0.0;
  /// For safety: the nearest point at the robot's heights. One is enough.
  std::vector<float> nearest_m;
  /// For localisation: the furthest point, which is a wall's rather than furniture's.
  std::vector<float> furthest_m;
};

/// The scan of a cloud in base, each ray at the bearing that it ended in. About 0.1 us a point.
VirtualScan virtual_scan(const Cloud& cloud_base, const ScanBand& band);

}  // namespace voxlist::planning
