#include "voxlist/planning/touched.h"

#include <algorithm>
#include <cmath>

namespace voxlist::planning {
namespace {

double farthest_m(const Cloud& cloud) {
  float farthest = 0.0F;
  for (const Eigen::Vector3f& p : cloud.points) farthest = std::max(farthest, p.squaredNorm());
  for (const Eigen::Vector3f& p : cloud.origins) farthest = std::max(farthest, p.squaredNorm());
  return std::sqrt(static_cast<double>(farthest));
}

}  // namespace

void Touched::add(const Pose3& T_map_base, const Cloud& cloud_base) {
  scratch_.mark(T_map_base, cloud_base);
  scratch_.for_each_block([&](const Voxel& block, CellStore::Block, CellStore::Block) {
    if (blocks_.size() == 0) lowest_ = highest_ = block;
    blocks_.number(block);
    lowest_ = {std::min(lowest_.x, block.x), std::min(lowest_.y, block.y),
               std::min(lowest_.z, block.z)};
    highest_ = {std::max(highest_.x, block.x), std::max(highest_.y, block.y),
                std::max(highest_.z, block.z)};
  });
}

bool Touched::is_reached_by(const PosedCloud& cloud) const {
  const double edge_m = kBlockEdge * scratch_.rules().resolution_m;
  const Eigen::Vector3d low = Eigen::Vector3d(lowest_.x, lowest_.y, lowest_.z) * edge_m;
  const Eigen::Vector3d high =
      Eigen::Vector3d(highest_.x + 1, highest_.y + 1, highest_.z + 1) * edge_m;
  const Eigen::Vector3d at = cloud.T_map_base.translation();
  // A cell is as much as rounding may be off.
  return blocks_.size() > 0 && (at.cwiseMax(low).cwiseMin(high) - at).norm() <=
                                   farthest_m(cloud.cloud) + scratch_.rules().resolution_m;
}

}  // namespace voxlist::planning
