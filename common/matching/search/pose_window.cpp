#include "voxlist/matching/search/pose_window.h"

#include <numbers>

namespace voxlist::matching {

PoseWindow whole_map(const VoxelMap& map) {
  PoseWindow window;
  window.half_yaw_rad = std::numbers::pi;
  const std::optional<VoxelBox> bounds = map.bounds();
  if (!bounds) return window;
  const auto& [low, high] = *bounds;
  const double half_m = map.resolution_m() / 2.0;
  window.center.x_m = (low.x + high.x + 1) * half_m;
  window.center.y_m = (low.y + high.y + 1) * half_m;
  window.half_x_m = (high.x + 1 - low.x) * half_m;
  window.half_y_m = (high.y + 1 - low.y) * half_m;
  return window;
}

}  // namespace voxlist::matching
