#pragma once

#include <functional>
#include <memory>

#include "voxlist/geometry/cloud.h"
#include "voxlist/geometry/uncertain_pose.h"
#include "voxlist/mapping/map_builder.h"
#include "voxlist/matching/localisation/reach_match.h"

namespace voxlist::mapping {

/// Hands out the cloud (in base) of a keyframe, by its number.
using ReadCloud = std::function<Cloud(std::size_t)>;

/// A map of few keyframes, in the frame of one of them, that scans are matched with.
class LocalMap {
 public:
  explicit LocalMap(const matching::MatcherConfig& config);

  void add(const Cloud& cloud, const Pose2& T_local_base);

  /// Where a scan was taken near a prediction, T_local_base.
  matching::ReachMatch match(const matching::PreparedScan& scan, const UncertainPose& predicted);

  /// Where a scan's points lie on the surfaces near `start`, T_local_base, in all six coordinates.
  matching::SpatialRefinement refined_in_space(const matching::MatchPoints& points,
                                               const Pose3& start);

 private:
  matching::MatcherConfig config_;
  MapBuilder builder_;
  matching::Matcher& matcher();

  std::unique_ptr<matching::Matcher> matcher_;
};

}  // namespace voxlist::mapping
