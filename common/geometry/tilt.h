#pragma once

#include <array>

#include "voxlist/geometry/cloud.h"
#include "voxlist/geometry/pose.h"

namespace voxlist {

/// What a planar pose leaves out of a spatial one. T_level_b takes frame b to a level frame with
/// the same origin in the plane and the same heading: pitched about y after being rolled about x,
/// then lifted.
struct Tilt {
  double z_m = 0.0;
  double roll_rad = 0.0;
  double pitch_rad = 0.0;

  bool operator==(const Tilt&) const = default;
};

/// T_level_b.
Pose3 to_level(const Tilt& tilt);

/// T_a_b = T_a_level * T_level_b.
Pose3 to_pose3(const Pose2& planar, const Tilt& tilt);

/// What to_pose2() leaves out: to_pose3(to_pose2(T), tilt_of(T)) is T.
Tilt tilt_of(const Pose3& pose);

/// The angle (rad) between b's z axis and the level frame's.
double lean_rad(const Tilt& tilt);

/// A cloud of frame b in frame a.
Cloud moved(const Pose3& T_a_b, const Cloud& cloud);

/// Whether clouds may be tilted or lifted against the map.
enum class TiltUse {
  /// They are level and at one height: poses are x, y and yaw.
  kPlanar,
  /// Height, roll and pitch are found as well: first by the floor or as they were, then by all
  /// surfaces.
  kRefine,
  /// The same, where odometry's roll and pitch come before the floor's.
  kOdometry,
};

/// Their names in a settings file.
inline constexpr std::array kTiltNames{"planar", "refine", "odometry"};

}  // namespace voxlist
