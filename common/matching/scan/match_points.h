#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "voxlist/geometry/cloud.h"

namespace voxlist::matching {

/// Which points of a scan take part in matching.
struct MatchPointsConfig {
  /// Points farther than this (m, horizontally) are left out: they would ask for finer angles than
  /// they repay.
  double max_range_m = 60.0;
  /// One point is kept of each cube of this edge (m), so that near surfaces do not outvote far
  /// ones.
  double spacing_m = 0.2;
  /// Most points kept; above it the fullest layers are thinned.
  int max_points = 2000;
  /// Edge of the cubes in which the scan is tested for flat-lying surfaces (m).
  double flat_cube_m = 0.32;
};

/// Points of a scan chosen for matching, in base, in a fixed order that does not depend on the
/// order of the scan.
struct MatchPoints {
  std::vector<Eigen::Vector3f> points;
  /// Where their rays started; empty: all at base's origin.
  std::vector<Eigen::Vector3f> origins;
  /// Largest horizontal distance of a point from base's origin (m).
  double radius_m = 0.0;
};

/// Points of a scan (in base), and where their rays started; no origins: all at base's own.
struct RayPoints {
  std::span<const Eigen::Vector3f> points, origins;

  RayPoints() = default;
  RayPoints(std::span<const Eigen::Vector3f> p) : points(p) {}
  RayPoints(const std::vector<Eigen::Vector3f>& p) : points(p) {}
  RayPoints(const MatchPoints& scan) : points(scan.points), origins(scan.origins) {}
  RayPoints(const Cloud& cloud) : points(cloud.points), origins(cloud.origins) {}
};

/// Chooses the points of a scan that tell poses (x, y, yaw) apart. Points of surfaces that lie flat
/// (floor, ceiling, table tops) match wherever the robot is: they are left out, unless nothing else
/// would remain. What remains is thinned to one point a cube, and layers of one spacing's height
/// are capped alike until `max_points` hold all. Empty when the scan has no point within range.
MatchPoints choose_match_points(const RayPoints& scan, const MatchPointsConfig& config);

/// About every k-th of the points, so that at most `most` remain: spread as they are.
MatchPoints some_of(const MatchPoints& points, std::size_t most);

}  // namespace voxlist::matching
