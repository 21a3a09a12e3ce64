#pragma once

#include <optional>

#include "voxlist/geometry/tilt.h"

namespace voxlist::matching {

/// Odometry as seen from above: wheels measure the way along a slope, a planar pose the shorter one
/// below it.
class LevelOdometry {
 public:
  /// T_odom_base with the way since the last noted pose foreshortened by the tilt there.
  Pose2 seen_from_above(const Pose2& T_odom_base, const Tilt& tilt) const;

  /// Goes on from a pose, where the robot is tilted like this.
  void note(const Pose2& T_odom_base, const Tilt& tilt);

 private:
  std::optional<Pose2> T_odom_last_;
  Pose2 T_level_last_;
};

}  // namespace voxlist::matching
