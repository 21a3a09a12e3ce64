#include "voxlist/voxels/voids/marked_scan.h"

#include <algorithm>
#include <cmath>

#include "voxlist/geometry/range.h"
#include "voxlist/voxels/voids/free_neighbours.h"
#include "voxlist/voxels/voxel_ray.h"

namespace voxlist {
namespace {

// Farther from the map's origin than this (m) rays are followed from a place of their own: a
// scratch reaches 2.6 km.
constexpr double kFar_m = 1000.0;

// The end of a ray begins so much (m) before the part that the scratch follows ends, whatever is
// rounded.
constexpr double kOverlap_m = 0.001;

RayRules rules_of(double min_range_m, double max_range_m, double cell_m) {
  RayRules rules;
  rules.resolution_m = cell_m;
  rules.min_range_m = min_range_m;
  rules.max_range_m = max_range_m;
  rules.end_gap_m = kVoidGap_m;
  return rules;
}

// The block near which a scan's rays are followed.
Voxel place_of(const Pose3& T_map_base, double block_m) {
  const Eigen::Vector3d at = T_map_base.translation();
  if (at.norm() < kFar_m) return {0, 0, 0};
  const auto block = [&](double m) { return static_cast<std::int32_t>(std::lround(m / block_m)); };
  return {block(at.x()), block(at.y()), block(at.z())};
}

// Where the last part of a ray begins.
Eigen::Vector3d begin_of_end(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const double way_m = (to - from).norm();
  return to - std::min((kVoidGap_m + kOverlap_m) / way_m, 1.0) * (to - from);
}

}  // namespace

MarkedScan::MarkedScan(double min_range_m, double max_range_m, double cell_m)
    : min_range_m_(min_range_m),
      max_range_m_(max_range_m),
      cell_m_(cell_m),
      scratch_(rules_of(min_range_m, max_range_m, cell_m)) {}

void MarkedScan::mark(const Pose3& T_map_base, const Cloud& cloud_base) {
  if (is_same(T_map_base, cloud_base)) return;
  ++number_;
  T_map_base_ = T_map_base;
  points_ = cloud_base.points;
  origins_ = cloud_base.origins;
  positions_.clear();
  blocks_.clear();
  take_early(T_map_base, cloud_base);
  mark_ends(T_map_base, cloud_base);
}

bool MarkedScan::is_same(const Pose3& T_map_base, const Cloud& cloud_base) const {
  return number_ > 0 && T_map_base.matrix() == T_map_base_.matrix() &&
         cloud_base.points == points_ && cloud_base.origins == origins_;
}

void MarkedScan::take_early(const Pose3& T_map_base, const Cloud& cloud_base) {
  const double block_m = kBlockEdge * cell_m_;
  const Voxel place = place_of(T_map_base, block_m);
  Pose3 T_place_base = T_map_base;
  T_place_base.translation() -= block_m * Eigen::Vector3d(place.x, place.y, place.z);
  scratch_.mark(T_place_base, cloud_base);
  scratch_.for_each_block([&](const Voxel& at, CellStore::Block passed, CellStore::Block hit) {
    Block& block = block_at({place.x + at.x, place.y + at.y, place.z + at.z});
    std::copy(hit.begin(), hit.end(), block.hit.begin());
    std::copy(passed.begin(), passed.end(), block.early.begin());
    block.passed = block.early;
  });
}

void MarkedScan::mark_ends(const Pose3& T_map_base, const Cloud& cloud_base) {
  ends_.clear();
  for (std::size_t i = 0; i < cloud_base.points.size(); ++i) {
    if (!is_within(cloud_base, i, min_range_m_, max_range_m_)) continue;
    const Eigen::Vector3d to = T_map_base * cloud_base.points[i].cast<double>();
    const Eigen::Vector3d from = T_map_base * cloud_base.origin(i).cast<double>();
    if (!in_lattice(to, kFinestResolution_m) || !in_lattice(from, kFinestResolution_m)) continue;
    const Voxel end = voxel_at(to, cell_m_);
    visit_ray(begin_of_end(from, to), to, cell_m_, [&](const Voxel& cell) {
      if (cell == end) return false;
      ends_.mark(cell);
      return true;
    });
  }
  ends_.for_each_block([&](const Voxel& at, const VoxelBlock& rows) {
    Block& block = block_at(at);
    const BlockBits bits = in_keys(rows);
    for (std::size_t i = 0; i < bits.size(); ++i) block.passed[i] |= bits[i];
  });
}

MarkedScan::Block& MarkedScan::block_at(const Voxel& at) {
  const std::uint32_t number = positions_.number(at);
  if (number == blocks_.size()) blocks_.push_back({at});
  return blocks_[number];
}

}  // namespace voxlist
