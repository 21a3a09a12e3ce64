#pragma once

#include "voxlist/planning/octomap.h"
#include "voxlist/voxels/counters/ray_scratch.h"
#include "voxlist/voxels/numbering.h"

namespace voxlist::planning {

/// The blocks that the rays of some clouds touch.
class Touched {
 public:
  /// The scratch is used for each cloud.
  explicit Touched(RayScratch& scratch) : scratch_(scratch) {}

  void add(const Pose3& T_map_base, const Cloud& cloud_base);

  const Numbering<Voxel>& blocks() const { return blocks_; }

  /// Whether a cloud's rays may get there: its farthest point is as far as the box of the blocks.
  bool is_reached_by(const PosedCloud& cloud) const;

 private:
  RayScratch& scratch_;
  Numbering<Voxel> blocks_;
  Voxel lowest_{}, highest_{};
};

}  // namespace voxlist::planning
