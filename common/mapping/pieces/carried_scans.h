#pragma once

#include <span>

#include "voxlist/geometry/cloud.h"

namespace voxlist::mapping {

/// Takes scans along where keyframes are moved, `before` to `after`: each keeps its place beside
/// the keyframe that was taken nearest in time, of several the one nearest to it. Precondition:
/// there is one.
void carry_scans(std::span<StampedPose3> scans, std::span<const StampedPose3> before,
                 std::span<const StampedPose3> after);

}  // namespace voxlist::mapping
