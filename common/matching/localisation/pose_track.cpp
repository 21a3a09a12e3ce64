#include "voxlist/matching/localisation/pose_track.h"

#include <algorithm>
#include <cmath>

#include "voxlist/geometry/elementary.h"

namespace voxlist::matching {
namespace {

// Lost below this overlap ratio, or below this share of the last inlier ratio.
constexpr double kLeastOverlapRatio = 0.15, kLeastShare = 0.4;
// The window grows to all that motion allows when the inlier ratio falls below this share of the
// last one.
constexpr double kDoubtfulShare = 0.8;
// Support that falls so far below its running mean makes a pose doubtful, or lost.
constexpr double kDoubtfulDrop = 0.06, kLostDrop = 0.35;
constexpr double kSupportMemory = 0.7;
// Support means something where the map knows this share of the rays' ends.
constexpr double kKnownShare = 0.3;

// How far a prediction may be off, beside a share of the motion itself.
constexpr double kWindow_m = 0.4, kWindow_rad = 0.3;
constexpr double kWindowShare = 0.2;
// Steps in time count as at least and at most this long (s).
constexpr double kShortestStep_s = 0.1, kLongestStep_s = 3.0;

// A heavy-tailed prior on the distance from the prediction: decides between poses that fit alike.
// Odometry is worth more than a guess from the last step, the less the farther the robot went.
struct Prior {
  double weight, scale_m, scale_rad;
};
constexpr Prior kGuess{0.08, 0.5, 0.5}, kOdometry{0.2, 0.1, 0.1};
constexpr double kOdometryShare = 0.1;
// The most that it takes to believe an unlikely motion: wheels slip.
constexpr double kMostSurprise = 0.1;

double best_inlier_ratio(const Match& match) {
  return match.modes.empty() ? 0.0 : match.modes.front().inlier_ratio;
}

// Adds what a wider window gave.
void add(const Match& wide, Match& match) {
  match.modes.insert(match.modes.end(), wide.modes.begin(), wide.modes.end());
  match.certified = match.certified && wide.certified;
  match.complete = match.complete && wide.complete;
  match.poses_examined += wide.poses_examined;
}

bool map_knows(const Evidence& e) { return e.hits + e.misses >= kKnownShare * e.points; }

}  // namespace

PoseTrack::PoseTrack(const Cloud& cloud, const std::optional<Pose2>& T_odom_base, const Pose2& pose,
                     const std::optional<double>& support)
    : utime_us_(cloud.utime_us), pose_(pose), T_odom_base_(T_odom_base), support_(support) {}

Pose2 PoseTrack::predict(std::int64_t now_us, const std::optional<Pose2>& T_odom_now) const {
  if (T_odom_base_ && T_odom_now) return pose_ * (T_odom_base_->inverse() * *T_odom_now);
  const double dt_s = static_cast<double>(now_us - utime_us_) * 1e-6;
  // Only over a step about as long as the last: a pause, now or then, says nothing of it.
  const bool alike = dt_s > 0.5 * step_s_ && dt_s < 2.0 * step_s_;
  return alike ? pose_ * step_ : pose_;
}

double PoseTrack::surprise(const Pose2& pose, const Pose2& predicted, bool odometry_now) const {
  Prior prior = kGuess;
  if (T_odom_base_ && odometry_now) {
    prior = kOdometry;
    prior.scale_m += kOdometryShare * distance_m(predicted, pose_);
  }
  const double d = distance_m(pose, predicted) / prior.scale_m,
               turn = turn_rad(pose, predicted) / prior.scale_rad;
  return prior.weight * elementary::log1p(d * d + turn * turn);
}

Match PoseTrack::match(Matcher& matcher, const PreparedScan& scan,
                       const std::optional<Pose2>& T_odom_base, const MotionLimits& limits) const {
  const Pose2 predicted = predict(scan.cloud().utime_us, T_odom_base);
  Match match = matcher.match(scan, window(predicted));
  if (inlier_ratio_ == 0.0 || best_inlier_ratio(match) < kDoubtfulShare * inlier_ratio_)
    add(matcher.match(scan, widest_window(predicted, scan.cloud().utime_us, limits)), match);
  const auto score = [&](const MatchMode& mode) {
    return mode.inlier_ratio - surprise(mode.pose, predicted, T_odom_base.has_value());
  };
  const auto best =
      std::max_element(match.modes.begin(), match.modes.end(),
                       [&](const auto& a, const auto& b) { return score(a) < score(b); });
  if (best != match.modes.end()) std::rotate(match.modes.begin(), best, best + 1);
  return match;
}

// Where a prediction that is about right leaves the robot.
PoseWindow PoseTrack::window(const Pose2& predicted) const {
  const double half_m = kWindow_m + kWindowShare * distance_m(predicted, pose_);
  return {predicted, half_m, half_m, kWindow_rad + kWindowShare * turn_rad(predicted, pose_)};
}

// All that the robot can have moved.
PoseWindow PoseTrack::widest_window(const Pose2& predicted, std::int64_t now_us,
                                    const MotionLimits& limits) const {
  const double dt_s =
      std::clamp(static_cast<double>(now_us - utime_us_) * 1e-6, kShortestStep_s, kLongestStep_s);
  const double half_m = window(predicted).half_x_m + limits.speed_mps * dt_s;
  return {predicted, half_m, half_m, kWindow_rad + limits.turn_rate_radps * dt_s};
}

PoseTrack::Judgement PoseTrack::judge(const Cloud& cloud, const std::optional<Pose2>& T_odom_base,
                                      const MatchMode& mode, const Evidence& evidence) const {
  const double supported = support_of(evidence);
  // Only what wheels measured speaks against a motion, not that the last step was another.
  const double unlikely = T_odom_base_ && T_odom_base
                              ? surprise(mode.pose, predict(cloud.utime_us, T_odom_base), true)
                              : 0.0;
  const double worth = supported - std::min(unlikely, kMostSurprise);
  if (mode.overlap_ratio < kLeastOverlapRatio || mode.inlier_ratio < kLeastShare * inlier_ratio_)
    return {Verdict::kLost, worth};
  if (!support_ || !map_knows(evidence)) return {Verdict::kExplains, worth};
  if (*support_ - supported > kLostDrop) return {Verdict::kLost, worth};
  const bool doubtful = *support_ - worth > kDoubtfulDrop;
  return {doubtful ? Verdict::kDoubtful : Verdict::kExplains, worth};
}

void PoseTrack::advance(const Cloud& cloud, const std::optional<Pose2>& T_odom_base,
                        const MatchMode& mode, const Evidence& evidence) {
  step_ = pose_.inverse() * mode.pose;
  step_s_ = static_cast<double>(cloud.utime_us - utime_us_) * 1e-6;
  utime_us_ = cloud.utime_us;
  pose_ = mode.pose;
  T_odom_base_ = T_odom_base;
  inlier_ratio_ = mode.inlier_ratio;
  if (!map_knows(evidence)) return;
  const double now = support_of(evidence);
  support_ = support_ ? kSupportMemory * *support_ + (1.0 - kSupportMemory) * now : now;
}

}  // namespace voxlist::matching
