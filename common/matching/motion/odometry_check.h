#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "voxlist/geometry/uncertain_pose.h"

namespace voxlist::matching {

/// What odometry told of a way, beside what the scans told.
struct OdometryError {
  /// Length of the way by odometry, and the time that it took.
  double way_m = 0.0, seconds = 0.0;
  /// What odometry's end of the way is off by.
  double distance_m = 0.0, turn_rad = 0.0;
  /// The same in standard deviations of what odometry and the scans may be off by.
  double sigmas = 0.0;

  /// Wheels slip or stand still while the robot moves, rather than being measured badly.
  bool disagrees() const;
};

/// Compares odometry with poses that scans are sure of, over ways of up to ten seconds: from one
/// scan to the next a slip shows, over many what is wrong all the time. Along what nothing in sight
/// holds, poses are as unsure as they say, and odometry is not blamed.
class OdometryCheck {
 public:
  /// Takes a pose and odometry's at the same time. Returns the worst error of the ways that end
  /// there, or one pose before: a slip is told when two poses have seen it. Nothing before the
  /// fourth pose, or without odometry.
  std::optional<OdometryError> add(std::int64_t utime_us, const UncertainPose& T_map_base,
                                   const std::optional<Pose2>& T_odom_base);

  /// The next pose is no continuation: the robot may have been carried.
  void clear() { past_.clear(); }

 private:
  struct Sample {
    std::int64_t utime_us;
    UncertainPose T_map_base;
    Pose2 T_odom_base;
    // Way and turns by odometry up to there.
    double way_m, turned_rad;
  };

  std::optional<OdometryError> worst() const;
  static OdometryError error(const Sample& from, const Sample& to);

  std::deque<Sample> past_;  // oldest first
};

}  // namespace voxlist::matching
