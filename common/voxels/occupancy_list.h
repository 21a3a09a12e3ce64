#pragma once

#include <map>
#include <memory>
#include <span>
#include <vector>

#include "voxlist/voxels/voxel.h"

namespace voxlist {

/// A set of occupied voxels (paper, section III): sorted, each voxel once.
class OccupancyList {
 public:
  /// The voxels that hold at least one of the points. Points (m) outside the lattice (see
  /// in_lattice) are dropped.
  static OccupancyList from_points(std::span<const Eigen::Vector3f> points,
                                   double resolution_m = kFinestResolution_m);

  /// The given voxels, in any order, repeated or not.
  OccupancyList(std::vector<Voxel> voxels, double resolution_m);

  /// The same space in voxels `factor` times as large (paper, Algorithm 2). Computed once and
  /// cached, as the paper does; the reference lives as long as this list. Not safe to call from
  /// several threads at once.
  const OccupancyList& down_sampled(int factor) const;

  double resolution_m() const { return resolution_m_; }
  std::size_t size() const { return voxels_.size(); }
  std::span<const Voxel> voxels() const { return voxels_; }

 private:
  double resolution_m_;
  std::vector<Voxel> voxels_;
  mutable std::map<int, std::shared_ptr<const OccupancyList>> down_sample_cache_;
};

}  // namespace voxlist
