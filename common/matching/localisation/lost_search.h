#pragma once

#include <optional>

#include "voxlist/geometry/cloud.h"
#include "voxlist/matching/engines/matcher.h"
#include "voxlist/matching/localisation/hypotheses.h"
#include "voxlist/matching/localisation/localisation.h"
#include "voxlist/matching/localisation/pose_track.h"

namespace voxlist::matching {

/// Finds a robot that does not know where it is: searches the whole map for each scan, and follows
/// the hypotheses over the motion between scans, by odometry or from scan to scan, until one of
/// them is sure.
class LostSearch {
 public:
  LostSearch(const MatcherConfig& config, const MotionLimits& limits);

  /// Modes come with their probabilities, the most probable first. TRACKING: the first is sure.
  /// AMBIGUOUS: one of the modes is probably right. LOST: probably none. `hint`: likely places near
  /// it are weighed with those that the search lists, and like them.
  Localisation add(const PreparedScan& scan, const std::optional<Pose2>& T_odom_base,
                   Matcher& matcher, const std::optional<UncertainPose>& hint = std::nullopt);

 private:
  void follow(const PreparedScan& scan, const std::optional<Pose2>& T_odom_base);
  bool stands(const std::optional<Pose2>& T_odom_base) const;
  bool was_carried(const PreparedScan& scan, const std::optional<Pose2>& T_odom_base) const;
  std::optional<Pose2> motion_to(const PreparedScan& scan,
                                 const std::optional<Pose2>& T_odom_base) const;
  void find_again(const PreparedScan& scan, Matcher& matcher, std::vector<PoseMode>& modes) const;

  const MatcherConfig config_;
  const MotionLimits limits_;
  Hypotheses hypotheses_;
  Cloud last_;
  std::optional<Pose2> T_odom_last_;
  // The scan with which the wheels came to stand.
  struct {
    Cloud cloud;
    std::optional<Pose2> T_odom_base;
  } standing_;
  bool is_carried_ = false;  // in the last scan
};

}  // namespace voxlist::matching
