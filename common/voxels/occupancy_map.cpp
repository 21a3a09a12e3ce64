#include "voxlist/voxels/occupancy_map.h"

#include <algorithm>

#include "voxlist/voxels/scan_cells.h"
#include "voxlist/voxels/scan_hits.h"
#include "voxlist/voxels/scan_rays.h"

namespace voxlist {
namespace {

void sort_once(std::vector<Voxel>& blocks) {
  std::sort(blocks.begin(), blocks.end());
  blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
}

// Blocks of one map that another one has otherwise, or not at all.
void list_other(const VoxelMap& map, const VoxelMap& than, std::vector<Voxel>& blocks) {
  for (std::size_t i = 0; i < map.block_count(); ++i) {
    const VoxelBlock* other = than.find_block(map.block_position(i));
    if (map.block(i) != (other ? *other : VoxelBlock{})) blocks.push_back(map.block_position(i));
  }
}

std::vector<Voxel> difference(const VoxelMap& a, const VoxelMap& b) {
  std::vector<Voxel> blocks;
  list_other(a, b, blocks);
  list_other(b, a, blocks);
  sort_once(blocks);
  return blocks;
}

}  // namespace

ChangedBlocks difference(const OccupancyMap& from, const OccupancyMap& to) {
  return {difference(from.occupied, to.occupied), difference(from.passed, to.passed),
          from.revision(), to.revision()};
}

ChangedBlocks add_scan(const Cloud& cloud_base, const Pose3& T_map_base, double max_range_m,
                       OccupancyMap& map) {
  const double resolution_m = map.occupied.resolution_m();
  const double passed_resolution_m = map.passed.resolution_m();
  ChangedBlocks changed;
  changed.from = map.revision();
  ScanHits hits;
  ScanCells passed;
  visit_rays(cloud_base, T_map_base, max_range_m, resolution_m,
             [&](const Eigen::Vector3d& origin, const Eigen::Vector3d& point) {
               hits.mark(voxel_at(point, resolution_m));
               mark_passed(origin, point, passed_resolution_m, passed);
               if (passed.memory_bytes() > kMaxScanBytes)
                 passed.move_to(map.passed, changed.passed);
             });
  passed.move_to(map.passed, changed.passed);
  changed.occupied = hits.put_into(map.occupied);
  sort_once(changed.passed);
  changed.to = map.revision();
  return changed;
}

}  // namespace voxlist
