#include "voxlist/voxels/edits/edit_limits.h"

#include <fmt/core.h>

#include <cmath>

namespace voxlist {
namespace {

// Farthest from a map's origin that anything of it lies (m).
constexpr double kReach_m = 10'000.0;

bool is_within_reach(const Eigen::AlignedBox3d& box) {
  return box.min().allFinite() && box.max().allFinite() && box.min().minCoeff() > -kReach_m &&
         box.max().maxCoeff() < kReach_m;
}

std::string fault_of(const Eigen::AlignedBox3d& box) {
  if (!is_within_reach(box)) return "the box lies beyond 10 km, or nowhere";
  if (box.sizes().minCoeff() < kShortestEdge_m || box.sizes().maxCoeff() > kLongestEdge_m)
    return fmt::format("an edge of the box is not from {} to {} m", kShortestEdge_m,
                       kLongestEdge_m);
  return {};
}

}  // namespace

std::string fault_of(const std::vector<Eigen::AlignedBox3d>& boxes) {
  if (boxes.size() > kMostEdits) return fmt::format("a map has {} boxes at most", kMostEdits);
  double volume_m3 = 0.0;
  for (const Eigen::AlignedBox3d& box : boxes) {
    if (std::string fault = fault_of(box); !fault.empty()) return fault;
    volume_m3 += box.volume();
  }
  if (volume_m3 <= kMostEdited_m3) return {};
  return fmt::format("all boxes together take more than {} m3", kMostEdited_m3);
}

bool is_sane_move(const Pose2& T) {
  return std::abs(T.x_m) < 2.0 * kReach_m && std::abs(T.y_m) < 2.0 * kReach_m &&
         std::isfinite(T.yaw_rad);
}

}  // namespace voxlist
