#include "voxlist/matching/floors/floor_view.h"

#include <algorithm>
#include <cmath>

#include "voxlist/geometry/elementary.h"

namespace voxlist::matching {
namespace {

// Other floors are at least so far (m) above the robot's or below it: no table is one.
constexpr double kStorey_m = 1.8;

// Floors are compared by powers of what they leave unexplained, as places in reach are
// (reach_confidence.cpp).
constexpr double kPlacePower = 12.0, kSlack = 0.05;

double log_unexplained(const FloorView& view) {
  return elementary::log(1.0 - std::clamp(view.support, 0.0, 1.0) + kSlack);
}

std::vector<ScanRay> rays_of(const MatchPoints& points, const Pose3& T_map_base) {
  const Eigen::Isometry3f T = T_map_base.cast<float>();
  std::vector<ScanRay> rays;
  for (std::size_t i = 0; i < points.points.size(); ++i) {
    const Eigen::Vector3f origin =
        points.origins.empty() ? Eigen::Vector3f::Zero() : points.origins[i];
    rays.push_back({T * origin, T * points.points[i]});
  }
  return rays;
}

}  // namespace

FloorView view_near(Matcher& matcher, const MatchPoints& points, const Pose3& start) {
  FloorView view{matcher.refined_in_space(points, start).pose};
  const Evidence e = matcher.evidence_on_surfaces({}, rays_of(points, view.T_map_base));
  view.support = support_of(e);
  return view;
}

std::vector<FloorView> views_of_others(Matcher& matcher, const MatchPoints& points,
                                       const Pose3& T_map_base,
                                       const std::vector<double>& heights_m) {
  std::vector<FloorView> views;
  for (const double height_m : heights_m) {
    Pose3 start = T_map_base;
    start.translation().z() = height_m;
    if (std::abs(height_m - T_map_base.translation().z()) >= kStorey_m)
      views.push_back(view_near(matcher, points, start));
  }
  return views;
}

double log_odds_between(const FloorView& floor, const FloorView& other) {
  return kPlacePower * (log_unexplained(other) - log_unexplained(floor));
}

}  // namespace voxlist::matching
