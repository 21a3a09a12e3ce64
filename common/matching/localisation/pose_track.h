#pragma once

#include <cstdint>
#include <optional>

#include "voxlist/geometry/cloud.h"
#include "voxlist/matching/engines/matcher.h"
#include "voxlist/matching/localisation/lost_search.h"
#include "voxlist/matching/surfaces/evidence.h"

namespace voxlist::matching {

/// What tracking goes on from: the last pose, the motion since, and how well scans agreed lately.
class PoseTrack {
 public:
  /// Begins at a pose, with what supported it; nothing where there was no map yet.
  PoseTrack(const Cloud& cloud, const std::optional<Pose2>& T_odom_base, const Pose2& pose,
            const std::optional<double>& support);

  /// Where the robot should be: by odometry, else by the last step.
  Pose2 predict(std::int64_t now_us, const std::optional<Pose2>& T_odom_now) const;

  /// Matches a cloud round the prediction, in all that motion allows when that is doubtful. Which
  /// mode is taken weighs its inlier ratio against how far the prediction is off; it comes first.
  /// Modes may be empty.
  Match match(Matcher& matcher, const PreparedScan& scan, const std::optional<Pose2>& T_odom_base,
              const MotionLimits& limits) const;

  /// How well a pose explains its scan: beside the scans before, and the motion since. What the map
  /// does not know is no objection.
  enum class Verdict { kExplains, kDoubtful, kLost };
  struct Judgement {
    Verdict verdict;
    /// The pose's support, less what it takes to believe that motion.
    double worth = 0.0;
  };
  Judgement judge(const Cloud& cloud, const std::optional<Pose2>& T_odom_base,
                  const MatchMode& mode, const Evidence& evidence) const;

  /// Goes on from a pose.
  void advance(const Cloud& cloud, const std::optional<Pose2>& T_odom_base, const MatchMode& mode,
               const Evidence& evidence);

 private:
  PoseWindow window(const Pose2& predicted) const;
  PoseWindow widest_window(const Pose2& predicted, std::int64_t now_us,
                           const MotionLimits& limits) const;
  double surprise(const Pose2& pose, const Pose2& predicted, bool odometry_now) const;

  std::int64_t utime_us_;
  Pose2 pose_;
  std::optional<Pose2> T_odom_base_;
  // Motion of the last step in base, and how long it took.
  Pose2 step_;
  double step_s_ = 0.0;
  // The last cloud's; 0: there was nothing to compare with yet.
  double inlier_ratio_ = 0.0;
  // A running mean over the last clouds; nothing before one was seen where the map knows much.
  std::optional<double> support_;
};

}  // namespace voxlist::matching
