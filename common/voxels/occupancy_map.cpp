#include "voxels/occupancy_map.h"

#include <algorithm>

#include "voxels/voxel_ray.h"

namespace voxlist {
namespace {

void sort_once(std::vector<Voxel>& blocks) {
  std::sort(blocks.begin(), blocks.end());
  blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
}

void mark(const Voxel& voxel, VoxelMap& map, std::vector<Voxel>& changed) {
  if (!map.insert(voxel)) return;
  const Voxel block = block_of(voxel);
  if (changed.empty() || changed.back() != block) changed.push_back(block);
}

}  // namespace

ChangedBlocks add_scan(const Cloud& cloud_base, const Pose3& T_map_base, double max_range_m,
                       OccupancyMap& map) {
  ChangedBlocks changed;
  for (std::size_t i = 0; i < cloud_base.points.size(); ++i) {
    const Eigen::Vector3f &point = cloud_base.points[i], origin = cloud_base.origin(i);
    if (!((point - origin).norm() <= static_cast<float>(max_range_m))) continue;
    const Eigen::Vector3d p = T_map_base * point.cast<double>();
    const Eigen::Vector3d o = T_map_base * origin.cast<double>();
    if (!in_lattice(p, map.occupied.resolution_m()) || !in_lattice(o, map.occupied.resolution_m()))
      continue;
    mark(voxel_at(p, map.occupied.resolution_m()), map.occupied, changed.occupied);
    const Voxel end = voxel_at(p, map.passed.resolution_m());
    visit_ray(o, p, map.passed.resolution_m(), [&](const Voxel& cell) {
      if (cell != end) mark(cell, map.passed, changed.passed);
      return cell != end;
    });
  }
  sort_once(changed.occupied);
  sort_once(changed.passed);
  return changed;
}

}  // namespace voxlist
