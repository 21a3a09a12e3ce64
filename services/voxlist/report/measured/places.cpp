#include "services/voxlist/report/measured/places.h"

#include <fmt/core.h>

#include <cmath>
#include <numbers>
#include <set>

namespace voxlist::desk {

double degrees(double radians) { return radians * 180.0 / std::numbers::pi; }

std::string metres(double value) { return fmt::format("{:.3f} m", value); }

std::string millimetres(double metres) { return fmt::format("{:.1f} mm", metres * 1e3); }

std::string in_degrees(double radians) { return fmt::format("{:.2f} deg", degrees(radians)); }

std::vector<Cell> plan_of(const VoxelMap& map, double edge, double low_m, double high_m) {
  std::set<std::pair<int, int>> columns;
  map.for_each_voxel([&](const Voxel& voxel) {
    const Eigen::Vector3d middle = center(voxel, map.resolution_m());
    const double half_m = map.resolution_m() / 2.0;
    if (middle.z() + half_m < low_m || middle.z() - half_m > high_m) return;
    columns.emplace(static_cast<int>(std::floor(middle.x() / edge)),
                    static_cast<int>(std::floor(middle.y() / edge)));
  });
  std::vector<Cell> cells;
  for (const auto& [x, y] : columns) cells.push_back({{x * edge, y * edge}, 1.0});
  return cells;
}

std::vector<Eigen::Vector2d> plan_of(const Cloud& scan, const Pose2& pose, double low_m,
                                     double high_m) {
  std::vector<Eigen::Vector2d> points;
  for (const Eigen::Vector3f& point : scan.points) {
    const Eigen::Vector3d there = pose * Eigen::Vector3d(point.cast<double>());
    if (there.z() >= low_m && there.z() <= high_m) points.emplace_back(there.x(), there.y());
  }
  return points;
}

VoxelMap coarser(const VoxelMap& map, int factor) {
  VoxelMap result(map.resolution_m() * factor);
  map.for_each_voxel([&](const Voxel& v) {
    result.insert({floor_div(v.x, factor), floor_div(v.y, factor), floor_div(v.z, factor)});
  });
  return result;
}

}  // namespace voxlist::desk
