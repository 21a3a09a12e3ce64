#pragma once

#include "voxlist/system/instructions.h"
#include "voxlist/voxels/counters/point_job.h"

namespace voxlist {

/// Makes rays of the points that are hits: see is_within(); both ends within kReach. Returns how
/// many.
std::size_t take_points(PointJob& job, Instructions instructions);

/// Moves rays and marks their ends. Returns how many are kept; they come first.
std::size_t mark_ends(const EndJob& job, Instructions instructions);

/// Marks the cells of rays. The cells are the same for all instructions. Once something found no
/// room (CellBits::is_full), the rest means nothing.
void mark_rays(const RayJob& job, Instructions instructions);

}  // namespace voxlist
