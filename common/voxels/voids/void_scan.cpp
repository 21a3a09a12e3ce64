#include "voxlist/voxels/voids/void_scan.h"

#include <algorithm>

namespace voxlist {
namespace {

RayRules rules_of(const VoidRule& rule, double min_range_m, double max_range_m) {
  RayRules rules;
  rules.resolution_m = rule.cell_m;
  rules.min_range_m = min_range_m;
  rules.max_range_m = max_range_m;
  rules.end_gap_m = kVoidGap_m;
  return rules;
}

VoxelBlock free_cells(CellStore::Block passed, CellStore::Block hit) {
  BlockBits free;
  for (std::size_t i = 0; i < free.size(); ++i) free[i] = passed[i] & ~hit[i];
  return in_rows(free);
}

VoxelBlock both(VoxelBlock a, const VoxelBlock& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] &= b[i];
  return a;
}

}  // namespace

VoidScan::VoidScan(const VoidRule& rule, double min_range_m, double max_range_m)
    : rule_(rule), scratch_(rules_of(rule, min_range_m, max_range_m)) {}

void VoidScan::mark(const Pose3& T_map_base, const Cloud& cloud_base) {
  scratch_.mark(T_map_base, cloud_base);
  positions_.clear();
  blocks_.clear();
  free_.clear();
  scratch_.for_each_block([&](const Voxel& at, CellStore::Block passed, CellStore::Block hit) {
    positions_.number(at);
    blocks_.push_back({at});
    std::copy(hit.begin(), hit.end(), blocks_.back().hit.begin());
    free_.push_back(free_cells(passed, hit));
  });
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    if (free_[i] == VoxelBlock{}) continue;
    const VoxelBlock wide = with_marked_around(around(blocks_[i].at), rule_.fewest_free);
    blocks_[i].is_void = in_keys(both(free_[i], wide));
  }
}

BlocksAround VoidScan::around(const Voxel& block) const {
  BlocksAround blocks;
  for (std::int32_t i = 0; i < 27; ++i) {
    const std::uint32_t number =
        positions_.find({block.x + i % 3 - 1, block.y + i / 3 % 3 - 1, block.z + i / 9 - 1});
    blocks[static_cast<std::size_t>(i)] =
        number == Numbering<Voxel>::kNone ? nullptr : &free_[number];
  }
  return blocks;
}

}  // namespace voxlist
