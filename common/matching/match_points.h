#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

namespace voxlist {

/// Which points of a scan take part in matching.
struct MatchPointsConfig {
  /// Points farther than this (m, horizontally) are left out: they would ask for finer angles than they repay.
  double max_range_m = 60.0;
  /// One point is kept of each cube of this edge (m), so that near surfaces do not outvote far ones.
  double spacing_m = 0.2;
  /// Most points kept; above it they are thinned evenly.
  int max_points = 2000;
};

/// Points of a scan chosen for matching, in base, in a fixed order that does not depend on the order of the scan.
struct MatchPoints {
  std::vector<Eigen::Vector3f> points;
  /// Largest horizontal distance of a point from base's origin (m).
  double radius_m = 0.0;
};

/// Thins a scan for matching. Horizontal layers that are mostly full (floor, ceiling) match wherever the robot is, so
/// no layer of one spacing's height keeps more points than `max_points` spread over the layers evenly would give the
/// full ones. Empty when the scan has no point within range.
MatchPoints choose_match_points(std::span<const Eigen::Vector3f> points, const MatchPointsConfig& config);

}  // namespace voxlist
