#pragma once

#include <tuple>

#include "voxlist/calibration/surface_fit.h"

namespace voxlist::calibration {

/// A plane, and a square of half a metre on it, along the axes that lie most in the plane. (Squares
/// across it would sort the beams by their errors.)
using Patch = std::tuple<std::size_t, int, int>;

Patch patch_of(const SurfaceEvidence& evidence, const SurfaceFit& fit, const Contact& contact);

/// Takes away the contacts of patches that lie off their plane, in the mean by more than half the
/// thickness: a picture on the wall, the front of the next cupboard.
void drop_uneven_patches(SurfaceEvidence& evidence, const SurfaceFit& fit);

}  // namespace voxlist::calibration
