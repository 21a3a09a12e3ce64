#include "voxlist/matching/paper/overlap.h"

namespace voxlist::matching {

int overlap(std::span<const Voxel> scan, const VoxelMap& map, const Voxel& offset) {
  int count = 0;
  for (const Voxel& v : scan) {
    count += map.contains({v.x + offset.x, v.y + offset.y, v.z + offset.z});
  }
  return count;
}

}  // namespace voxlist::matching
