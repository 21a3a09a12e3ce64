#include "voxlist/mapping/loops/spatial_look.h"

#include <cmath>

namespace voxlist::mapping {
namespace {

// Heights at which it is looked (m) are so far apart: points find surfaces from half of that.
constexpr double kStep_m = 0.1;
// So many of a scan's points lie on the surfaces of the others. A judgement: most of them.
constexpr double kMost = 0.5;

matching::MatchPoints points_of(const Cloud& cloud, matching::ScanConfig config) {
  config.match_heights_m.clear();  // it is floors and ceilings that tell height, roll and pitch
  return matching::PreparedScan(cloud, config).spatial_points();
}

Pose3 lifted(const Pose2& pose, double height_m) { return to_pose3(pose, {height_m, 0.0, 0.0}); }

}  // namespace

std::optional<UncertainPose3> look_in_space(const SpatialLook& look, const ReadCloud& read,
                                            const matching::MatcherConfig& config) {
  LocalMap map(config);
  for (const auto& other : look.others) map.add(read(other.keyframe), other.T_from_other);
  const Cloud cloud = read(look.keyframe);
  const matching::MatchPoints points = points_of(cloud, config.scan);
  matching::SpatialRefinement best = map.refined_in_space(points, to_pose3(look.expected));
  const int steps = static_cast<int>(std::ceil(look.off_m / kStep_m));
  for (int i = -steps; i <= steps; ++i) {
    if (i == 0) continue;
    const auto found = map.refined_in_space(points, lifted(look.expected, i * kStep_m));
    if (found.inlier_ratio > best.inlier_ratio) best = found;
  }
  if (!best.converged || best.inlier_ratio < kMost) return std::nullopt;
  return UncertainPose3{best.pose, best.covariance};
}

}  // namespace voxlist::mapping
