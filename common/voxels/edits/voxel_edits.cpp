#include "voxlist/voxels/edits/voxel_edits.h"

#include <utility>

namespace voxlist {

VoxelEdits::VoxelEdits(const std::vector<PlacedBox>& boxes, double resolution_m, Kinds taken,
                       Kinds put)
    : edits_(boxes, resolution_m), taken_(std::move(taken)), put_(std::move(put)) {}

VoxelMap VoxelEdits::apply(VoxelMap voxels) const {
  // A block is changed by itself alone.
  for (std::size_t i = 0; i < voxels.block_count(); ++i)
    update(voxels, voxels.block_position(i), voxels);
  for (const EditKind kind : put_)
    for (const Voxel& block : edits_.blocks_of(kind)) update(voxels, block, voxels);
  return voxels;
}

std::vector<Voxel> VoxelEdits::follow(const VoxelMap& voxels, const std::vector<Voxel>& changed,
                                      VoxelMap& edited) const {
  std::vector<Voxel> changed_there;
  for (const Voxel& block : changed)
    if (update(voxels, block, edited)) changed_there.push_back(block);
  return changed_there;
}

bool VoxelEdits::update(const VoxelMap& voxels, const Voxel& block, VoxelMap& edited) const {
  const VoxelBlock* const before = voxels.find_block(block);
  VoxelBlock bits = before ? *before : VoxelBlock{};
  const BlockEdits::Cells cells = edits_.cells_of(block);
  for (std::size_t z = 0; z < bits.size(); ++z) {
    for (const EditKind kind : taken_) bits[z] &= ~cells.of(kind)[z];
    for (const EditKind kind : put_) bits[z] |= cells.of(kind)[z];
  }
  return edited.set_block(block, bits);
}

}  // namespace voxlist
