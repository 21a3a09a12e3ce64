#include "voxlist/matching/localisation/pose_track.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "voxlist/geometry/elementary.h"
#include "voxlist/matching/localisation/reach_match.h"

namespace voxlist::matching {
namespace {

// Odometry errs by these standard deviations (m, rad), and by these shares of the way and of the
// turn: wheels slip, their size and the laser's mount are known to a few per cent.
constexpr double kOdometry_m = 0.02, kOdometryShare = 0.05;
constexpr double kOdometry_rad = 0.01, kOdometryTurnShare = 0.05, kOdometry_rad_per_m = 0.01;

// Without odometry, the last step goes on but for what the robot's speed and turn rate change by,
// as a standard deviation: at least so much (m/s^2, rad/s^2), more where lately it was more.
constexpr double kLeastAcceleration = 0.1, kLeastTurnAcceleration = 0.1;
// What the robot's last changes of speed count for, beside the newest one.
constexpr double kMemory = 0.8;
constexpr double kSteady_m = 0.02, kSteady_rad = 0.02;

// A step says nothing of a time that is so many times as long.
constexpr double kLongestGuess = 5.0;

// Steps in time count as at least so long (s): two clouds may come together.
constexpr double kShortestStep_s = 0.1;

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

// The farthest that a robot goes is so many standard deviations of a motion that nothing tells.
constexpr double kReachSigmas = 3.0;

Eigen::Matrix3d diagonal(double sigma_m, double sigma_rad) {
  return Eigen::Vector3d(sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad).asDiagonal();
}

double length_m(const Pose2& motion) { return distance_m({}, motion); }

}  // namespace

PoseTrack::PoseTrack(std::int64_t utime_us, const std::optional<Pose2>& T_odom_base,
                     const UncertainPose& pose, const MotionLimits& limits)
    : limits_(limits), utime_us_(utime_us), T_odom_base_(T_odom_base), pose_(pose) {}

UncertainPose PoseTrack::predict(std::int64_t now_us,
                                 const std::optional<Pose2>& T_odom_now) const {
  const UncertainPose step = motion(now_us, T_odom_now);
  UncertainPose predicted = pose_ * step;
  if (by_odometry(T_odom_now)) return predicted;
  // A guess's errors go on from step to step: what one was off, the next is off as well. So errors
  // add up, not their squares.
  const double before = std::sqrt(pose_.covariance.topLeftCorner<2, 2>().trace()),
               now = std::sqrt(step.covariance.topLeftCorner<2, 2>().trace());
  const Eigen::Matrix3d own = predicted.covariance - (pose_ * UncertainPose{step.pose}).covariance;
  if (before > 0.0)
    predicted.covariance =
        (1.0 + now / before) * (predicted.covariance - own) + (1.0 + before / now) * own;
  return predicted;
}

UncertainPose PoseTrack::motion(std::int64_t now_us, const std::optional<Pose2>& T_odom_now) const {
  if (!by_odometry(T_odom_now)) return guessed_motion(seconds_to(now_us));
  const Pose2 way = T_odom_base_->inverse() * *T_odom_now;
  const double sigma_m = kOdometry_m + kOdometryShare * length_m(way);
  const double sigma_rad = kOdometry_rad + kOdometryTurnShare * std::abs(way.yaw_rad) +
                           kOdometry_rad_per_m * length_m(way);
  return {way, diagonal(sigma_m, sigma_rad)};
}

UncertainPose PoseTrack::guessed_motion(double dt_s) const {
  UncertainPose unknown = unknown_motion(dt_s);
  if (!step_ || step_s_ <= 0.0 || dt_s > kLongestGuess * step_s_) return unknown;
  const double share = dt_s / step_s_;
  const UncertainPose goes_on{
      part_of(step_->pose, share),
      share * share * step_->covariance + diagonal(kSteady_m + acceleration_ * dt_s * dt_s,
                                                   kSteady_rad + turn_acceleration_ * dt_s * dt_s)};
  return goes_on.covariance(0, 0) < unknown.covariance(0, 0) ? goes_on : unknown;
}

double PoseTrack::seconds_to(std::int64_t now_us) const {
  return std::max(static_cast<double>(now_us - utime_us_) * 1e-6, kShortestStep_s);
}

UncertainPose PoseTrack::unknown_motion(double dt_s) const {
  return {{},
          diagonal(limits_.speed_mps * dt_s / kReachSigmas,
                   std::min(limits_.turn_rate_radps * dt_s, std::numbers::pi) / kReachSigmas)};
}

Localisation PoseTrack::match(Matcher& matcher, const PreparedScan& scan,
                              const std::optional<Pose2>& T_odom_base) const {
  const UncertainPose predicted = predict(scan.cloud().utime_us, T_odom_base);
  ReachMatch reach = match_in_reach(matcher, scan, predicted, in_reach_);
  if (reach.best() < kSureInReach && !by_odometry(T_odom_base)) {
    const UncertainPose anywhere = pose_ * unknown_motion(seconds_to(scan.cloud().utime_us));
    if (anywhere.covariance(0, 0) > predicted.covariance(0, 0)) {
      ReachMatch wider = match_in_reach(matcher, scan, anywhere, kSudden * in_reach_);
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

void PoseTrack::advance(std::int64_t utime_us, const std::optional<Pose2>& T_odom_base,
                        const UncertainPose& pose) {
  const double dt_s = static_cast<double>(utime_us - utime_us_) * 1e-6;
  const UncertainPose guess = predict(utime_us, T_odom_base), way = motion(utime_us, T_odom_base);
  // What the match told of the pose beside the prediction, it told of the step.
  const Eigen::Matrix3d told = guess.covariance.llt().matrixL().solve(Eigen::Matrix3d::Identity());
  const Eigen::Matrix3d to_step = Eigen::Matrix3d(way.covariance.llt().matrixL()) * told;
  if (!by_odometry(T_odom_base) && step_) learn(guess.pose, pose.pose, dt_s);
  step_ = UncertainPose{pose_.pose.inverse() * pose.pose,
                        to_step * pose.covariance * to_step.transpose()};
  step_s_ = dt_s;
  utime_us_ = utime_us;
  T_odom_base_ = T_odom_base;
  pose_ = pose;
}

bool PoseTrack::doubtful() const { return in_reach_ < kDoubtful; }

// What the robot's speed and turn rate changed by.
void PoseTrack::learn(const Pose2& guess, const Pose2& pose, double dt_s) {
  const double time2 = std::max(dt_s * dt_s, kShortestStep_s * kShortestStep_s);
  const auto follow = [](double& sigma, double now, double least) {
    sigma = std::max(least, std::sqrt(kMemory * sigma * sigma + (1.0 - kMemory) * now * now));
  };
  follow(acceleration_, distance_m(guess, pose) / time2, kLeastAcceleration);
  follow(turn_acceleration_, turn_rad(guess, pose) / time2, kLeastTurnAcceleration);
}

}  // namespace voxlist::matching
