#pragma once

#include <optional>

#include "voxlist/geometry/cloud.h"
#include "voxlist/matching/engines/matcher.h"

namespace voxlist::matching {

/// Two scans of one place, taken within seconds, lie on each other's surfaces with more than this
/// share of their points; fewer do where something hides what was seen before. Chosen by judgement.
inline constexpr double kLeastInlierRatio = 0.3;

/// The motion of base from one cloud to the next, by matching the second with the first within the
/// window (motions in base at the first). Nothing when fewer points than the least ratio fit.
std::optional<Pose2> scan_motion(const Cloud& before, const PreparedScan& now,
                                 const PoseWindow& window, const MatcherConfig& config,
                                 double least_inlier_ratio = kLeastInlierRatio);

}  // namespace voxlist::matching
