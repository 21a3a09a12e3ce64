#pragma once

#include <vector>

#include "voxlist/geometry/tilt.h"
#include "voxlist/matching/engines/matcher.h"

namespace voxlist::matching {

/// A scan as it lies on one of a map's floors.
struct FloorView {
  Pose3 T_map_base = Pose3::Identity();
  /// What the map says to it there, at most 1 (support_of).
  double support = 0.0;
};

/// Lays a scan (in base) onto the map's surfaces near `start`, and weighs it there. About 1 ms for
/// 400 points.
FloorView view_near(Matcher& matcher, const MatchPoints& points, const Pose3& start);

/// The same on each other floor that is above or below a pose. `heights_m`: of all floors there.
std::vector<FloorView> views_of_others(Matcher& matcher, const MatchPoints& points,
                                       const Pose3& T_map_base,
                                       const std::vector<double>& heights_m);

/// Logarithm of the odds between two floors by what they say to one scan.
double log_odds_between(const FloorView& floor, const FloorView& other);

}  // namespace voxlist::matching
