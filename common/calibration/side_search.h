#pragma once

#include <span>

#include "voxlist/calibration/mirror_beam.h"

namespace voxlist::calibration {

/// Finds by how much phase 1 should be greater against phase 0 (radians), roughly, so that the
/// mirror's two sides see one room: the one with the fewest occupied voxels. Looks up to 5 deg to
/// both sides. 0 when only one side was used.
double side_difference(std::span<const MirrorBeam> beams, const ParameterVector& parameters);

}  // namespace voxlist::calibration
