#include "voxlist/voxels/occupancy_map.h"

#include <algorithm>

#include "voxlist/voxels/scan_cells.h"
#include "voxlist/voxels/voxel_ray.h"

namespace voxlist {
namespace {

// Bytes that the cells of a scan may take before they go into the map: 2000 tiles of 5 m, more than
// a scan within a building fills. It bounds memory; results do not depend on it.
constexpr std::size_t kMaxScanBytes = 64'000'000;

void insert(const Voxel& voxel, VoxelMap& map, std::vector<Voxel>& changed) {
  if (!map.insert(voxel)) return;
  const Voxel block = block_of(voxel);
  if (changed.empty() || changed.back() != block) changed.push_back(block);
}

void sort_once(std::vector<Voxel>& blocks) {
  std::sort(blocks.begin(), blocks.end());
  blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
}

}  // namespace

ChangedBlocks add_scan(const Cloud& cloud_base, const Pose3& T_map_base, double max_range_m,
                       OccupancyMap& map) {
  const double resolution_m = map.occupied.resolution_m();
  const double passed_resolution_m = map.passed.resolution_m();
  ChangedBlocks changed;
  changed.from = map.revision();
  ScanCells passed;
  for (std::size_t i = 0; i < cloud_base.points.size(); ++i) {
    const Eigen::Vector3f &point = cloud_base.points[i], origin = cloud_base.origin(i);
    if (!((point - origin).norm() <= static_cast<float>(max_range_m))) continue;
    const Eigen::Vector3d p = T_map_base * point.cast<double>();
    const Eigen::Vector3d o = T_map_base * origin.cast<double>();
    if (!in_lattice(p, resolution_m) || !in_lattice(o, resolution_m)) continue;
    insert(voxel_at(p, resolution_m), map.occupied, changed.occupied);
    const Voxel end = voxel_at(p, passed_resolution_m);
    visit_ray(o, p, passed_resolution_m, [&](const Voxel& cell) {
      if (cell == end) return false;
      passed.mark(cell);
      return true;
    });
    if (passed.memory_bytes() > kMaxScanBytes) passed.move_to(map.passed, changed.passed);
  }
  passed.move_to(map.passed, changed.passed);
  sort_once(changed.occupied);
  sort_once(changed.passed);
  changed.to = map.revision();
  return changed;
}

}  // namespace voxlist
