#pragma once

#include <string>
#include <vector>

#include "services/voxlist/report/charts/chart.h"
#include "services/voxlist/report/measured/scene.h"
#include "voxlist/voxels/voxel_map.h"

namespace voxlist::desk {

/// Degrees of an angle in radians.
double degrees(double radians);

/// "0.012 m", "3.4 mm", "0.25 deg".
std::string metres(double value);
std::string millimetres(double metres);
std::string in_degrees(double radians);

/// How sides of a map look on a plan: columns in which a voxel lies between these heights (m), as
/// squares of `edge` m.
std::vector<Cell> plan_of(const VoxelMap& map, double edge, double low_m = 0.5,
                          double high_m = 1.9);

/// The points of a scan on a plan, at a pose; those between the same heights.
std::vector<Eigen::Vector2d> plan_of(const Cloud& scan, const Pose2& pose, double low_m = 0.5,
                                     double high_m = 1.9);

/// Middles of a map's voxels in coarser ones, `factor` times as wide (Algorithm 2).
VoxelMap coarser(const VoxelMap& map, int factor);

}  // namespace voxlist::desk
