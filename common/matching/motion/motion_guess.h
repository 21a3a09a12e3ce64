#pragma once

#include <optional>

#include "voxlist/geometry/uncertain_pose.h"

namespace voxlist::matching {

/// Fastest motion to expect where nothing measures it.
struct MotionLimits {
  double speed_mps = 0.0;
  double turn_rate_radps = 0.0;
};

/// What is expected of a motion that no odometry measures: the last step goes on, but for what
/// speed and turn rate change by, as they did lately.
class MotionGuess {
 public:
  explicit MotionGuess(const MotionLimits& limits) : limits_(limits) {}

  /// Where the robot should be some time (s) after its last pose.
  UncertainPose pose(const UncertainPose& last, double dt_s) const;

  /// The same of a robot that may have moved off at any speed.
  UncertainPose anywhere(const UncertainPose& last, double dt_s) const;

  /// Learns a step that took some time (s). `guessed`: the new pose is a match that began with
  /// pose().
  void learn(const UncertainPose& last, const UncertainPose& now, double dt_s, bool guessed);

 private:
  UncertainPose motion(double dt_s) const;
  UncertainPose unknown_motion(double dt_s) const;
  Eigen::Matrix3d told_of_step(const UncertainPose& last, const UncertainPose& now,
                               double dt_s) const;
  void learn_changes(const Pose2& guess, const Pose2& pose, double dt_s);

  MotionLimits limits_;
  // Motion of the last step in base, and how long it took (s).
  std::optional<UncertainPose> step_;
  double step_s_ = 0.0;
  // What speed and turn rate change by (m/s^2, rad/s^2), as a standard deviation.
  double acceleration_ = 0.5, turn_acceleration_ = 0.5;
};

}  // namespace voxlist::matching
