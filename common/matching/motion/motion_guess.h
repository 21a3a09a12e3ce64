#pragma once

#include "voxlist/geometry/uncertain_pose.h"
#include "voxlist/matching/motion/tracked_pose.h"

namespace voxlist::matching {

/// Fastest motion to expect where nothing measures it.
struct MotionLimits {
  double speed_mps = 0.0;
  double turn_rate_radps = 0.0;
};

/// What is expected of a motion that no odometry measures: the robot's velocity goes on, but for
/// what speed and turn rate change by, as they did lately.
class MotionGuess {
 public:
  explicit MotionGuess(const MotionLimits& limits) : limits_(limits) {}

  /// Moves a pose on by some time (s) since it was known.
  void follow(TrackedPose& pose, double dt_s) const;

  /// Where a robot should be after some time (s) that may have moved off at any speed.
  UncertainPose anywhere(const UncertainPose& last, double dt_s) const;

  /// Learns what became of a motion that took some time (s): the pose before it, the one that was
  /// expected, and the one that is believed now, whose velocity is set where none was known.
  /// `guessed`: it was follow() that expected it.
  void learn(const TrackedPose& before, const Pose2& expected, TrackedPose& now, double dt_s,
             bool guessed);

 private:
  bool knows_velocity(double dt_s) const;
  Eigen::Vector3d unknown_velocity(double dt_s) const;

  MotionLimits limits_;
  // How long the last motion took (s); 0: there was none.
  double last_s_ = 0.0;
  // What speed and turn rate change by (m/s^2, rad/s^2), as a standard deviation.
  double acceleration_ = 0.5, turn_acceleration_ = 0.5;
};

}  // namespace voxlist::matching
