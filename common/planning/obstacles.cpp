#include "voxlist/planning/obstacles.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "voxlist/geometry/angle.h"
#include "voxlist/geometry/elementary.h"

namespace voxlist::planning {
namespace {

using CellKey = std::pair<int, int>;
using CellCounts = std::map<CellKey, int>;

CellKey cell_of(const Eigen::Vector3f& p, double cell_m) {
  return {static_cast<int>(std::floor(p.x() / cell_m)),
          static_cast<int>(std::floor(p.y() / cell_m))};
}

std::vector<Eigen::Vector3f> in_band(const Cloud& cloud, const ObstacleConfig& config) {
  std::vector<Eigen::Vector3f> points;
  for (const Eigen::Vector3f& p : cloud.points) {
    const double height = p.z() - config.floor_z_m, range = elementary::hypot(p.x(), p.y());
    if (height >= config.min_height_m && height <= config.max_height_m &&
        range >= config.min_range_m && range <= config.max_range_m)
      points.push_back(p);
  }
  return points;
}

int support(const CellCounts& counts, const CellKey& cell) {
  int points = 0;
  for (int dx = -1; dx <= 1; ++dx)
    for (int dy = -1; dy <= 1; ++dy) {
      const auto found = counts.find({cell.first + dx, cell.second + dy});
      if (found != counts.end()) points += found->second;
    }
  return points;
}

CellCounts supported(const CellCounts& counts, int min_points) {
  CellCounts kept;
  for (const auto& [cell, count] : counts)
    if (support(counts, cell) >= min_points) kept.emplace(cell, count);
  return kept;
}

std::size_t sector_of(const Eigen::Vector3f& p, int sectors) {
  const double turns = elementary::atan2(p.y(), p.x()) / kTurn_rad;
  const auto sector = static_cast<int>(std::lround(turns * sectors));
  return static_cast<std::size_t>((sector + sectors) % sectors);
}

}  // namespace

ObstacleScan nearest_obstacles(const Cloud& cloud_base, const ObstacleConfig& config) {
  const std::vector<Eigen::Vector3f> points = in_band(cloud_base, config);
  CellCounts counts;
  for (const Eigen::Vector3f& p : points) ++counts[cell_of(p, config.cell_m)];
  const CellCounts obstacles = supported(counts, config.min_points);

  ObstacleScan scan;
  scan.utime_us = cloud_base.utime_us;
  scan.step_rad = kTurn_rad / config.sectors;
  scan.ranges_m.assign(static_cast<std::size_t>(config.sectors),
                       std::numeric_limits<float>::infinity());
  for (const Eigen::Vector3f& p : points) {
    if (!obstacles.contains(cell_of(p, config.cell_m))) continue;
    float& range = scan.ranges_m[sector_of(p, config.sectors)];
    range = std::min(range, static_cast<float>(elementary::hypot(p.x(), p.y())));
  }
  for (const auto& [cell, count] : obstacles)
    scan.cells_m.emplace_back(
        (static_cast<float>(cell.first) + 0.5F) * static_cast<float>(config.cell_m),
        (static_cast<float>(cell.second) + 0.5F) * static_cast<float>(config.cell_m));
  return scan;
}

}  // namespace voxlist::planning
