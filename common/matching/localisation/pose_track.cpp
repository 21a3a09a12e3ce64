#include "voxlist/matching/localisation/pose_track.h"

#include <algorithm>

#include "voxlist/matching/engines/along_way.h"
#include "voxlist/matching/localisation/reach_confidence.h"
#include "voxlist/matching/localisation/reach_match.h"
#include "voxlist/matching/motion/pose_fusion.h"

namespace voxlist::matching {
namespace {

// Where nothing is found where it should be, and no wheels were asked, the robot has moved
// otherwise than before with this probability.
constexpr double kSudden = 0.5;

// Before a scan is looked at, the robot is in reach of the prediction with this probability, if it
// was so at the scan before: nobody has carried it, and the scan shows it. A judgement.
constexpr double kStays = 0.995;
// Below this the robot may well be elsewhere: after two bad scans.
constexpr double kDoubtful = 0.95;
// A scan that fits nowhere in reach is bad, rather than the robot elsewhere, with this probability.
// A judgement: after twenty such scans in a row, half of the belief is gone.
constexpr double kBadScan = 0.97;

// After a scan that was sure, a place is believed from this probability on without a look at the
// rest of the map. Carried robots that were taken for being where they were expected came to 0.9994
// (bench_confidence, seeds 211 to 213). Higher: more searches of the whole map, 20 to 150 ms each.
constexpr double kPlain = 0.9999;

// Wheels that slip measure up to twice the way, or half of it: so much of the way that they measure
// is wrong.
constexpr double kSlip = 0.5;
// The way since surfaces held the pose counts up to this (m): a slip that farther back was not
// seen is in the map by now, and looking farther takes longer.
constexpr double kFarthest_m = 0.5;
// Whether a scan told the place along a way, beside what was expected.
bool held_along(const Eigen::Vector3d& way, const Eigen::Matrix3d& expected,
                const Eigen::Matrix3d& matched) {
  const Eigen::Vector3d along = way.stableNormalized();
  const auto known = [&](const Eigen::Matrix3d& covariance) {
    return 1.0 / std::max(along.dot(covariance * along), 1e-12);
  };
  return known(matched) - known(expected) > 1.0 / (kHeld_m * kHeld_m);
}

Eigen::Vector3d way_between(const Pose2& from, const Pose2& to) {
  return {to.x_m - from.x_m, to.y_m - from.y_m, 0.0};
}

// Lines may seem to hold a pose that the motion leaves vague: where nothing else does, it is as
// vague as that.
void doubt_lines(Matcher& matcher, const PreparedScan& scan, const UncertainPose& predicted,
                 ReachMatch& reach) {
  if (reach.best() < kSureInReach || is_exact(predicted.covariance)) return;
  MatchMode& best = reach.match.modes.front();
  const Eigen::Matrix3d covariance = matcher.covariance_without_lines(scan, best, predicted);
  if (!is_exact(covariance)) best.covariance = covariance;
}

}  // namespace

PoseTrack::PoseTrack(std::int64_t utime_us, const std::optional<Pose2>& T_odom_base,
                     const UncertainPose& pose, const MotionLimits& limits)
    : utime_us_(utime_us), T_odom_base_(T_odom_base), now_(pose), guess_(limits) {}

UncertainPose PoseTrack::predict(std::int64_t now_us,
                                 const std::optional<Pose2>& T_odom_now) const {
  return moved(now_us, T_odom_now).pose();
}

TrackedPose PoseTrack::moved(std::int64_t now_us, const std::optional<Pose2>& T_odom_now) const {
  TrackedPose moved = now_;
  if (by_odometry(T_odom_now))
    moved.follow_odometry(T_odom_base_->inverse() * *T_odom_now, seconds_to(now_us));
  else
    guess_.follow(moved, seconds_to(now_us));
  return moved;
}

double PoseTrack::seconds_to(std::int64_t now_us) const {
  return static_cast<double>(now_us - utime_us_) * 1e-6;
}

Localisation PoseTrack::match(Matcher& matcher, const PreparedScan& scan,
                              const std::optional<Pose2>& T_odom_base) {
  const std::int64_t now_us = scan.cloud().utime_us;
  const UncertainPose predicted = scatter_.expected(predict(now_us, T_odom_base));
  ReachMatch reach = match_in_reach(matcher, scan, predicted, in_reach_);
  doubt_lines(matcher, scan, predicted, reach);
  if (reach.best() < kSureInReach && !by_odometry(T_odom_base)) {
    const UncertainPose anywhere = guess_.anywhere(now_.pose(), seconds_to(now_us));
    if (anywhere.covariance(0, 0) > predicted.covariance(0, 0)) {
      ReachMatch wider = match_in_reach(matcher, scan, anywhere, kSudden * in_reach_);
      doubt_lines(matcher, scan, anywhere, wider);
      if (wider.best() > reach.best()) reach = std::move(wider);
    }
  }
  slipped_ = false;
  if (by_odometry(T_odom_base)) doubt_wheels(matcher, scan, predicted, reach);
  if (reach.best() >= kSureInReach && is_suspect(predicted, reach))
    weigh_elsewhere(matcher, scan, in_reach_, reach);
  const auto& [match, probability] = reach;
  Localisation result = from_match(scan, match);
  for (std::size_t i = 0; i < result.modes.size(); ++i)
    result.modes[i].probability = probability[i];
  if (!probability.empty()) result.confidence = probability.front();
  return result;
}

// Whether the scan tells the place along the way, but not plainly. Along a bare corridor all places
// look alike, and rings that hit the spots of an earlier scan make one of them fit better.
bool PoseTrack::is_suspect(const UncertainPose& predicted, const ReachMatch& reach) const {
  return (doubted_ || reach.best() < kPlain) &&
         held_along(way_between(now_.pose().pose, predicted.pose), predicted.covariance,
                    reach.match.modes.front().covariance);
}

// Where surfaces do not hold a pose along its way, refinement leaves it where wheels have it.
void PoseTrack::doubt_wheels(Matcher& matcher, const PreparedScan& scan,
                             const UncertainPose& predicted, ReachMatch& reach) {
  const Eigen::Vector3d way = way_between(now_.pose().pose, predicted.pose);
  if (reach.best() < kSureInReach ||
      held_along(way, predicted.covariance, reach.match.modes.front().covariance))
    return;
  slipped_ = let_slip(matcher, scan, predicted, way, reach);
}

// A place along the way that explains the scan better is as probable as it fits, wherever a slip
// may have taken the wheels.
bool PoseTrack::let_slip(Matcher& matcher, const PreparedScan& scan, const UncertainPose& predicted,
                         const Eigen::Vector3d& way, ReachMatch& reach) const {
  const Eigen::Vector3d driven = way + std::min(unheld_m_, kFarthest_m) * way.stableNormalized();
  const Eigen::Vector2d slip = kSlip * driven.head<2>();
  auto& modes = reach.match.modes;
  const auto better = matcher.better_along(scan, modes.front(), predicted, slip);
  if (!better) return false;
  UncertainPose slipped = predicted;
  slipped.covariance.topLeftCorner<2, 2>() += slip * slip.transpose();
  modes.insert(modes.begin(), *better);
  reach.probabilities = rank_in_reach(slipped, std::nullopt, in_reach_, modes);
  return modes.front().pose == better->pose;
}

void PoseTrack::doubt(double right) {
  doubted_ = right < kSureInReach;
  in_reach_ = kStays * (right + (1.0 - right) * kBadScan * in_reach_);
}

UncertainPose PoseTrack::advance(std::int64_t utime_us, const std::optional<Pose2>& T_odom_base,
                                 const UncertainPose& matched) {
  TrackedPose now = moved(utime_us, T_odom_base);
  const Pose2 expected = now.pose().pose;
  if (slipped_) {
    const Eigen::Vector3d slip = difference(matched.pose, expected);
    now.blur(slip * slip.transpose());
  }
  const Eigen::Vector3d way = way_between(now_.pose().pose, expected);
  const bool held = held_along(way, now.pose().covariance, matched.covariance);
  unheld_m_ = held ? 0.0 : unheld_m_ + way.norm();
  scatter_.correct(now, matched);
  guess_.learn(now_, expected, now, seconds_to(utime_us), !by_odometry(T_odom_base));
  utime_us_ = utime_us;
  T_odom_base_ = T_odom_base;
  now_ = now;
  return now.pose();
}

bool PoseTrack::doubtful() const { return in_reach_ < kDoubtful; }

}  // namespace voxlist::matching
