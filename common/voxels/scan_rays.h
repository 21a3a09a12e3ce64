#pragma once

#include "voxlist/geometry/cloud.h"
#include "voxlist/geometry/pose.h"
#include "voxlist/voxels/occupancy_map.h"
#include "voxlist/voxels/scan_cells.h"
#include "voxlist/voxels/voxel_ray.h"

namespace voxlist {

/// Bytes that the cells of a scan may take before they go into the map: 2000 tiles of 5 m, more
/// than a scan within a building fills. It bounds memory; results do not depend on it.
inline constexpr std::size_t kMaxScanBytes = 64'000'000;

/// Calls visit(origin, point), both in the map, for each ray of a scan (in base) that may go into
/// it: not longer than max_range_m, both ends within the lattice.
template <class Visit>
void visit_rays(const Cloud& cloud_base, const Pose3& T_map_base, double max_range_m,
                double resolution_m, const Visit& visit) {
  for (std::size_t i = 0; i < cloud_base.points.size(); ++i) {
    const Eigen::Vector3f &point = cloud_base.points[i], origin = cloud_base.origin(i);
    if (!((point - origin).norm() <= static_cast<float>(max_range_m))) continue;
    const Eigen::Vector3d p = T_map_base * point.cast<double>();
    const Eigen::Vector3d o = T_map_base * origin.cast<double>();
    if (in_lattice(p, resolution_m) && in_lattice(o, resolution_m)) visit(o, p);
  }
}

/// Marks the cells that a ray passes on its way to the cell that it ends in, which is not marked.
inline void mark_passed(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double resolution_m,
                        ScanCells& cells) {
  const Voxel end = voxel_at(to, resolution_m);
  visit_ray(from, to, resolution_m, [&](const Voxel& cell) {
    if (cell == end) return false;
    cells.mark(cell);
    return true;
  });
}

}  // namespace voxlist
