#include "voxlist/matching/localisation/pose_track.h"

#include "voxlist/matching/localisation/reach_match.h"

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
                              const std::optional<Pose2>& T_odom_base) const {
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
  const auto& [match, probability] = reach;
  Localisation result = from_match(scan, match);
  for (std::size_t i = 0; i < result.modes.size(); ++i)
    result.modes[i].probability = probability[i];
  if (!probability.empty()) result.confidence = probability.front();
  return result;
}

void PoseTrack::doubt(double right) {
  in_reach_ = kStays * (right + (1.0 - right) * kBadScan * in_reach_);
}

UncertainPose PoseTrack::advance(std::int64_t utime_us, const std::optional<Pose2>& T_odom_base,
                                 const UncertainPose& matched) {
  TrackedPose now = moved(utime_us, T_odom_base);
  const Pose2 expected = now.pose().pose;
  scatter_.correct(now, matched);
  guess_.learn(now_, expected, now, seconds_to(utime_us), !by_odometry(T_odom_base));
  utime_us_ = utime_us;
  T_odom_base_ = T_odom_base;
  now_ = now;
  return now.pose();
}

bool PoseTrack::doubtful() const { return in_reach_ < kDoubtful; }

}  // namespace voxlist::matching
