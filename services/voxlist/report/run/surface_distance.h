#pragma once

#include <array>
#include <vector>

#include "voxlist/voxels/voxel_map.h"

namespace voxlist::desk {

/// Distances up to which a voxel counts as near (m): those of map benchmarks.
inline constexpr std::array kNear_m{0.02, 0.05, 0.10};

/// Shares of the voxels of one map that have a voxel of the other within each of kNear_m, centre to
/// centre. Both of one resolution. 0 where `from` is empty.
std::array<double, kNear_m.size()> shares_near(const VoxelMap& from, const VoxelMap& to);

}  // namespace voxlist::desk
