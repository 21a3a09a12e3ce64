#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "voxlist/geometry/pose.h"
#include "voxlist/matching/scan/match_points.h"
#include "voxlist/matching/surfaces/evidence.h"
#include "voxlist/matching/surfaces/surfels.h"

namespace voxlist::matching {

/// Where surfaces hold a pose along its way to this (m), as a standard deviation, it is theirs and
/// not the wheels'.
inline constexpr double kHeld_m = 0.1;

/// A place on a line, and how well it is known along it (m, a standard deviation).
struct PlaceOnLine {
  Pose2 pose;
  double sigma_m = 0.0;
};

/// The place along a line through a pose where the map explains a scan's rays best, if that is
/// better than at the pose by more than chance. `evidence`: of the rays at the pose, on surfaces.
/// `reach`: the line's half in map (m). Surfaces that hold no pose may tell places apart all the
/// same: rays end where a door stood open, or go through its leaf. It looks at no place where few
/// rays speak against the pose.
std::optional<PlaceOnLine> better_along(const EvidenceMap& map, const SurfelMap& surfels,
                                        std::span<const ScanRay> rays, const Pose2& pose,
                                        const Evidence& evidence, const Eigen::Vector2d& reach);

}  // namespace voxlist::matching
