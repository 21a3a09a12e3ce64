#pragma once

#include "voxlist/system/instructions.h"
#include "voxlist/voxels/counters/ray_job.h"

namespace voxlist {

/// Marks the cells of rays. The cells are the same for all instructions. Once something found no
/// room (CellBits::is_full), the rest means nothing.
void mark_rays(const RayJob& job, Instructions instructions);

}  // namespace voxlist
