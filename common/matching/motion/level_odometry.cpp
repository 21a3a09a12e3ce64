#include "voxlist/matching/motion/level_odometry.h"

#include "voxlist/geometry/elementary.h"

namespace voxlist::matching {

Pose2 LevelOdometry::seen_from_above(const Pose2& T_odom_base, const Tilt& tilt) const {
  if (!T_odom_last_) return T_odom_base;
  Pose2 step = T_odom_last_->inverse() * T_odom_base;
  step.x_m *= elementary::cos(tilt.pitch_rad);
  step.y_m *= elementary::cos(tilt.roll_rad);
  return T_level_last_ * step;
}

void LevelOdometry::note(const Pose2& T_odom_base, const Tilt& tilt) {
  T_level_last_ = seen_from_above(T_odom_base, tilt);
  T_odom_last_ = T_odom_base;
}

}  // namespace voxlist::matching
