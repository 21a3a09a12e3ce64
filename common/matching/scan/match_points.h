#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "voxlist/geometry/cloud.h"

namespace voxlist::matching {

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

/// One ray of a scan, from where it started to what it hit, in base (m).
struct ScanRay {
  Eigen::Vector3f origin, end;
};

}  // namespace voxlist::matching
