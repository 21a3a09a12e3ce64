#pragma once

#include <cstdint>
#include <optional>

#include "voxlist/geometry/cloud.h"
#include "voxlist/geometry/uncertain_pose.h"
#include "voxlist/matching/engines/matcher.h"
#include "voxlist/matching/localisation/localisation.h"
#include "voxlist/matching/motion/match_scatter.h"
#include "voxlist/matching/motion/motion_guess.h"
#include "voxlist/matching/motion/tracked_pose.h"

namespace voxlist::matching {

struct ReachMatch;

/// The last pose that is known, and what is known of the motion since: by odometry, or by its
/// velocity. It outlives scans that fit nowhere: the motion since grows, and so does the
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
                     const std::optional<Pose2>& T_odom_base);

  /// Goes on from a pose that the scan of that time was matched to, and that the prediction is part
  /// of. Returns the pose that is believed.
  UncertainPose advance(std::int64_t utime_us, const std::optional<Pose2>& T_odom_base,
                        const UncertainPose& matched);

  /// Goes on in another map. `T_new_old`: from the map so far to that one.
  void change_map(const Pose2& T_new_old) { now_.change_map(T_new_old); }

  /// Remembers how probable it was that the last scan's pose is right: after bad scans, more is
  /// asked of the next one.
  void doubt(double right);

  /// Whether the robot may well be elsewhere: one bad scan does not say so.
  bool doubtful() const;

  /// What odometry is off by, as far as it is known.
  OdometryBias odometry() const { return now_.odometry(); }

 private:
  TrackedPose moved(std::int64_t now_us, const std::optional<Pose2>& T_odom_now) const;
  bool is_suspect(const UncertainPose& predicted, const ReachMatch& reach) const;
  void doubt_wheels(Matcher& matcher, const PreparedScan& scan, const UncertainPose& predicted,
                    ReachMatch& reach);
  bool let_slip(Matcher& matcher, const PreparedScan& scan, const UncertainPose& predicted,
                const Eigen::Vector3d& way, ReachMatch& reach) const;
  double seconds_to(std::int64_t now_us) const;
  bool by_odometry(const std::optional<Pose2>& T_odom_now) const {
    return T_odom_base_ && T_odom_now;
  }

  std::int64_t utime_us_;
  std::optional<Pose2> T_odom_base_;
  TrackedPose now_;
  MotionGuess guess_;
  MatchScatter scatter_;
  double in_reach_ = 0.995;
  // Whether the last scan did not say for sure that the robot is in reach.
  bool doubted_ = false;
  // How far the robot has driven since surfaces held its pose along its way (m).
  double unheld_m_ = 0.0;
  // Whether the last match says that the wheels slipped.
  bool slipped_ = false;
};

}  // namespace voxlist::matching
