#include "voxlist/matching/search/pose_window.h"

#include <algorithm>
#include <numbers>

namespace voxlist::matching {

PoseWindow whole_map(const VoxelMap& map) {
  PoseWindow window;
  window.half_yaw_rad = std::numbers::pi;
  if (map.block_count() == 0) return window;
  Voxel low = map.block_position(0), high = low;
  for (std::size_t i = 1; i < map.block_count(); ++i) {
    const Voxel& block = map.block_position(i);
    low = {std::min(low.x, block.x), std::min(low.y, block.y), 0};
    high = {std::max(high.x, block.x), std::max(high.y, block.y), 0};
  }
  const double half_block_m = map.resolution_m() * kBlockEdge / 2.0;
  window.center.x_m = (low.x + high.x + 1) * half_block_m;
  window.center.y_m = (low.y + high.y + 1) * half_block_m;
  window.half_x_m = (high.x + 1 - low.x) * half_block_m;
  window.half_y_m = (high.y + 1 - low.y) * half_block_m;
  return window;
}

}  // namespace voxlist::matching
