#include "voxlist/mapping/loops/local_map.h"

namespace voxlist::mapping {
namespace {

// Before a scan is looked at, it was taken near the prediction with this probability. A judgement:
// it saw the same ground, or just not.
constexpr double kInReach = 0.5;

// Few keyframes, most of one time: what one of them sees to be gone may be hidden from the others.
MapBuilderConfig without_carving() {
  MapBuilderConfig config;
  config.carve = false;
  return config;
}

}  // namespace

LocalMap::LocalMap(const matching::MatcherConfig& config)
    : config_(config), builder_(without_carving()) {}

void LocalMap::add(const Cloud& cloud, const Pose2& T_local_base) {
  builder_.add({to_pose3(T_local_base), cloud});
  matcher_.reset();
}

matching::ReachMatch LocalMap::match(const matching::PreparedScan& scan,
                                     const UncertainPose& predicted) {
  return matching::match_in_reach(matcher(), scan, predicted, kInReach);
}

matching::SpatialRefinement LocalMap::refined_in_space(const matching::MatchPoints& points,
                                                       const Pose3& start) {
  return matcher().refined_in_space(points, start);
}

matching::Matcher& LocalMap::matcher() {
  if (!matcher_) matcher_ = matching::make_matcher(builder_.map(), config_);
  return *matcher_;
}

}  // namespace voxlist::mapping
