#pragma once

#include <array>

#include "voxlist/voxels/counters/cell_store.h"
#include "voxlist/voxels/voxel_map.h"

namespace voxlist {

/// A block's cells in the order of a VoxelBlock, from the order of their keys (see CellBits).
VoxelBlock in_rows(CellStore::Block words);

/// The other way round.
BlockBits in_keys(const VoxelBlock& block);

/// A block and the 26 round it, x first; nullptr: nothing is marked there.
using BlocksAround = std::array<const VoxelBlock*, 27>;

/// The cells of the block in the middle with at least `fewest` marked cells among the 27 of the
/// cube about them, themselves included. 64 cells at a time, about 1000 operations on bits.
VoxelBlock with_marked_around(const BlocksAround& blocks, unsigned fewest);

}  // namespace voxlist
