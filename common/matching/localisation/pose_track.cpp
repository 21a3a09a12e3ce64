#include "voxlist/matching/localisation/pose_track.h"

#include <algorithm>
#include <cmath>

#include "voxlist/geometry/elementary.h"

namespace voxlist::matching {
namespace {

// A track is lost below this overlap ratio of the search in its window: the scan is of another
// place, or nearly blind. Chosen by judgement. Lower: a pose that explains nothing goes on.
constexpr double kLeastOverlapRatio = 0.15;
// A track is lost when the inlier ratio falls below this share of the last scan's. Chosen by
// judgement; the same.
constexpr double kLeastShare = 0.4;
// The window grows to all that motion allows when the inlier ratio falls below this share of the
// last scan's. Never (0): 15 of the 89 scans of a hall without odometry are placed. Higher: two
// searches where one would do.
constexpr double kDoubtfulShare = 0.8;

// A pose is doubtful when its support falls so far below the running mean, and lost when it falls
// farther. Doubt costs a search of the whole map, 20 to 40 ms, and ends the track only when another
// pose is better (localiser.cpp); it was lowered from 0.08, with which a robot that was carried
// into a place alike went on tracking. Lower: more searches; higher: a robot that was carried away
// is not noticed.
constexpr double kDoubtfulDrop = 0.06, kLostDrop = 0.35;
// Share of the running mean that a new scan leaves in place: it is the mean of about the last
// three. Higher: the mean of a good place casts doubt on a poorer one for longer.
constexpr double kSupportMemory = 0.7;
// Support means something where the map knows this share of the rays' ends, as occupied or free.
// Chosen by judgement. Higher: nothing casts doubt at the edge of a map; lower: a few rays do.
constexpr double kKnownShare = 0.3;

// How far a prediction may be off (m, rad), beside a share of the motion itself: what the speed of
// a robot changes from scan to scan without odometry. Smaller: the pose lies outside, and takes a
// second search in the wide window (0.1 m and 0.05 rad still place all 89 scans of the hall);
// larger: time grows with the window's area.
constexpr double kWindow_m = 0.4, kWindow_rad = 0.3;
constexpr double kWindowShare = 0.2;
// Steps in time count as at least and at most this long (s) when all that motion allows is worked
// out: two clouds may come together, and after a long gap the window would be the whole floor.
constexpr double kShortestStep_s = 0.1, kLongestStep_s = 3.0;

// A heavy-tailed prior on the distance from the prediction: decides between poses that fit alike.
// Its weight is an inlier ratio, of which 0.7 times is taken off a pose one scale (m, rad) away,
// and 2.3 times one three scales away. Odometry is worth more than a guess from the last step, the
// less the farther the robot went. With a guess's weight of 0 all 89 scans of the hall are placed
// as they are, with 0.5 only 16: a wrong guess outweighs the scan. Lighter: a robot among alike
// shelves may jump between them.
struct Prior {
  double weight, scale_m, scale_rad;
};
constexpr Prior kGuess{0.08, 0.5, 0.5}, kOdometry{0.2, 0.1, 0.1};
// Odometry's scale grows by this share of the way (m) since the last scan: wheels that slip are off
// by a tenth of it.
constexpr double kOdometryShare = 0.1;
// The most support that it takes to believe an unlikely motion: wheels slip. Above kDoubtfulDrop,
// so that a motion which odometry denies casts doubt by itself; a carried robot had gone on
// tracking without that. Higher: poses that a slip explains are called lost elsewhere.
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
