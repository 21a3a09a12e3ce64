#include "voxlist/voxels/scan_hits.h"

#include <algorithm>

namespace voxlist {

std::vector<Voxel> ScanHits::put_into(VoxelMap& map) const {
  std::vector<Voxel> changed;
  for (std::size_t i = 0; i < blocks_.size(); ++i)
    if (map.merge_block(positions_.key(i), blocks_[i])) changed.push_back(positions_.key(i));
  std::sort(changed.begin(), changed.end());
  return changed;
}

void ScanHits::clear() {
  positions_.clear();
  blocks_.clear();
}

void ScanHits::go_to(const Voxel& block) {
  last_ = positions_.number(block);
  if (last_ == blocks_.size()) blocks_.emplace_back();
}

}  // namespace voxlist
