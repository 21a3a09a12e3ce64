#pragma once

#include <optional>

#include "voxlist/geometry/uncertain_pose.h"

namespace voxlist::matching {

/// Where somebody thinks that the robot is: a place to look at, for the next few scans.
class PoseHint {
 public:
  /// Takes T_map_base of now, instead of what was hinted before.
  void take(const UncertainPose& pose);

  void forget() { scans_left_ = 0; }

  /// Where the robot is at the next scan by the hint, and by odometry since the first scan after
  /// it. Nothing where there is no hint, or it has had its scans.
  std::optional<UncertainPose> next(const std::optional<Pose2>& T_odom_base);

 private:
  UncertainPose pose_;
  std::optional<Pose2> T_odom_base_;  // when the robot was at pose_
  int scans_left_ = 0;
};

}  // namespace voxlist::matching
