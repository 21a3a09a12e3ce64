#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

namespace voxlist::calibration {

/// The points p with normal . p = distance_m. Unit normal, away from the origin.
struct Plane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double distance_m = 0.0;

  double distance_to(const Eigen::Vector3d& point) const { return normal.dot(point) - distance_m; }
};

/// The large flat surfaces among the points: walls, floor, ceiling, cupboards; largest first. A
/// surface may be `tolerance_m` thick to either side. The same points give the same planes.
std::vector<Plane> find_planes(std::span<const Eigen::Vector3d> points, double tolerance_m);

/// For each point the plane within the tolerance; none when no plane is near, or more than one (an
/// edge of the room belongs to no surface).
std::vector<std::optional<std::size_t>> associate(std::span<const Eigen::Vector3d> points,
                                                  const std::vector<Plane>& planes,
                                                  double tolerance_m);

}  // namespace voxlist::calibration
