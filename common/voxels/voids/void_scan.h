#pragma once

#include <vector>

#include "voxlist/geometry/cloud.h"
#include "voxlist/geometry/pose.h"
#include "voxlist/voxels/counters/ray_scratch.h"
#include "voxlist/voxels/numbering.h"
#include "voxlist/voxels/voids/free_neighbours.h"

namespace voxlist {

/// When a scan sees that a cell is void: rays crossed it and nothing in it was hit, and the same
/// holds for at least so many of the 27 cells about it, itself included. Rays are followed up to
/// kVoidGap_m before their ends.
struct VoidRule {
  double cell_m;
  unsigned fewest_free;
};

/// What a ray passes nearer than this (m) to its end may be what it hits: a wall that is met at a
/// grazing angle, the noise of ranges and poses.
inline constexpr double kVoidGap_m = 0.2;

/// The cells that one scan hits, and those that it sees to be void. A void is larger than a thin
/// thing that rays miss: a pole fits into a gap between rays, but not into many side by side.
class VoidScan {
 public:
  VoidScan(const VoidRule& rule, double min_range_m, double max_range_m);

  /// Takes the cells of a scan (in base) in the place of those before.
  void mark(const Pose3& T_map_base, const Cloud& cloud_base);

  struct Block {
    Voxel at;
    BlockBits hit{}, is_void{};
  };

  /// Blocks that were passed or hit, always in the same order.
  const std::vector<Block>& blocks() const { return blocks_; }

 private:
  BlocksAround around(const Voxel& block) const;

  VoidRule rule_;
  RayScratch scratch_;
  Numbering<Voxel> positions_;
  std::vector<VoxelBlock> free_;  // by number
  std::vector<Block> blocks_;     // by number
};

}  // namespace voxlist
