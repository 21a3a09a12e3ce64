#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "voxlist/geometry/cloud.h"
#include "voxlist/geometry/uncertain_pose.h"
#include "voxlist/matching/engines/matcher.h"
#include "voxlist/matching/localisation/localisation.h"

namespace voxlist::matching {

/// Fastest motion to expect where nothing measures it.
struct MotionLimits {
  double speed_mps = 0.0;
  double turn_rate_radps = 0.0;
};

/// The last pose that is known, and what is known of the motion since: by odometry, or by the step
/// that led there. It outlives scans that fit nowhere: the motion since grows, and so does the
/// doubt.
class PoseTrack {
 public:
  /// Begins at a pose.
  PoseTrack(std::int64_t utime_us, const std::optional<Pose2>& T_odom_base,
            const UncertainPose& pose, const MotionLimits& limits);

  /// Where the robot should be now.
  UncertainPose predict(std::int64_t now_us, const std::optional<Pose2>& T_odom_now) const;

  /// The places that a scan may have been taken from within reach of the prediction, with their
  /// probabilities, the most probable first; what is missing to 1 is for none of them. Empty: the
  /// prediction is too vague for a window, or the scan nearly blind.
  Localisation match(Matcher& matcher, const PreparedScan& scan,
                     const std::optional<Pose2>& T_odom_base) const;

  /// Goes on from a pose that the scan of that time was matched to.
  void advance(std::int64_t utime_us, const std::optional<Pose2>& T_odom_base,
               const UncertainPose& pose);

  /// Remembers how probable it was that the last scan's pose is right: after bad scans, more is
  /// asked of the next one.
  void doubt(double right);

  /// Whether the robot may well be elsewhere: one bad scan does not say so.
  bool doubtful() const;

 private:
  UncertainPose motion(std::int64_t now_us, const std::optional<Pose2>& T_odom_now) const;
  UncertainPose guessed_motion(double dt_s) const;
  UncertainPose unknown_motion(double dt_s) const;
  double seconds_to(std::int64_t now_us) const;
  void learn(const Pose2& guess, const Pose2& pose, double dt_s);
  bool by_odometry(const std::optional<Pose2>& T_odom_now) const {
    return T_odom_base_ && T_odom_now;
  }

  const MotionLimits limits_;
  std::int64_t utime_us_;
  std::optional<Pose2> T_odom_base_;
  UncertainPose pose_;
  // Motion of the last step in base, and how long it took (s).
  std::optional<UncertainPose> step_;
  double step_s_ = 0.0;
  // What speed and turn rate change by (m/s^2, rad/s^2), as a standard deviation.
  double acceleration_ = 0.5, turn_acceleration_ = 0.5;
  double in_reach_ = 0.995;
};

}  // namespace voxlist::matching
