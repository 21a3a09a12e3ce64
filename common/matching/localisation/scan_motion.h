#pragma once

#include <optional>

#include "voxlist/geometry/cloud.h"
#include "voxlist/matching/engines/matcher.h"

namespace voxlist::matching {

/// The motion of base from one cloud to the next, by matching the second with the first within the
/// window (motions in base at the first). Nothing when they do not fit together.
std::optional<Pose2> scan_motion(const Cloud& before, const PreparedScan& now,
                                 const PoseWindow& window, const MatcherConfig& config);

}  // namespace voxlist::matching
