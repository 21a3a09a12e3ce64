#pragma once

#include <vector>

#include "voxlist/voxels/edits/block_edits.h"

namespace voxlist {

/// What edits make of a set of voxels: some kinds of boxes take voxels out, others put them in.
class VoxelEdits {
 public:
  using Kinds = std::vector<EditKind>;

  VoxelEdits(const std::vector<PlacedBox>& boxes, double resolution_m, Kinds taken, Kinds put);

  /// The voxels with all edits.
  VoxelMap apply(VoxelMap voxels) const;

  /// Brings what apply() made up to date with blocks that changed since. Returns those of them that
  /// changed there.
  std::vector<Voxel> follow(const VoxelMap& voxels, const std::vector<Voxel>& changed,
                            VoxelMap& edited) const;

 private:
  bool update(const VoxelMap& voxels, const Voxel& block, VoxelMap& edited) const;

  BlockEdits edits_;
  Kinds taken_, put_;
};

}  // namespace voxlist
