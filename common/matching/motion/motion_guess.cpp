#include "voxlist/matching/motion/motion_guess.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace voxlist::matching {
namespace {

// The velocity goes on but for what the robot's speed and turn rate change by, as a standard
// deviation: at least so much (m/s^2, rad/s^2), more where lately it was more.
constexpr double kLeastAcceleration = 0.1, kLeastTurnAcceleration = 0.1;
// What the robot's last changes of speed count for, beside the newest one.
constexpr double kMemory = 0.8;
constexpr double kSteady_m = 0.02, kSteady_rad = 0.02;

// A motion says nothing of a time that is so many times as long.
constexpr double kLongestGuess = 5.0;

// Steps in time count as at least so long (s): two clouds may come together.
constexpr double kShortestStep_s = 0.1;

// The farthest that a robot goes is so many standard deviations of a motion that nothing tells.
constexpr double kReachSigmas = 3.0;

}  // namespace

bool MotionGuess::knows_velocity(double dt_s) const {
  return last_s_ > 0.0 && dt_s <= kLongestGuess * last_s_;
}

void MotionGuess::follow(TrackedPose& pose, double dt_s) const {
  const double time_s = std::max(dt_s, kShortestStep_s);
  const Eigen::Vector3d unknown = unknown_velocity(time_s),
                        steady(kSteady_m, kSteady_m, kSteady_rad);
  const Eigen::Vector3d change =
      steady / time_s + time_s * Eigen::Vector3d(acceleration_, acceleration_, turn_acceleration_);
  // It is never vaguer than the fastest robot's, and is forgotten where it may have changed so far.
  if (!knows_velocity(time_s) || change.x() >= unknown.x()) pose.forget_velocity(unknown);
  const Eigen::Vector3d most =
      (unknown.cwiseAbs2() - pose.velocity_variances()).cwiseMax(0.0).cwiseSqrt();
  pose.go_on(time_s, change.cwiseMin(most));
}

UncertainPose MotionGuess::anywhere(const UncertainPose& last, double dt_s) const {
  TrackedPose moved(last);
  const double time_s = std::max(dt_s, kShortestStep_s);
  moved.forget_velocity(unknown_velocity(time_s));
  moved.go_on(time_s, Eigen::Vector3d::Zero());
  return moved.pose();
}

Eigen::Vector3d MotionGuess::unknown_velocity(double dt_s) const {
  const double speed = limits_.speed_mps / kReachSigmas;
  return {speed, speed, std::min(limits_.turn_rate_radps, std::numbers::pi / dt_s) / kReachSigmas};
}

void MotionGuess::learn(const TrackedPose& before, const Pose2& expected, TrackedPose& now,
                        double dt_s, bool guessed) {
  const bool known = knows_velocity(std::max(dt_s, kShortestStep_s));
  last_s_ = dt_s;
  if (!guessed) return;
  const Pose2 believed = now.pose().pose;
  if (!known)
    return now.set_velocity(before.pose().pose.inverse() * believed,
                            std::max(dt_s, kShortestStep_s));
  const double time2 = std::max(dt_s * dt_s, kShortestStep_s * kShortestStep_s);
  const auto follow = [](double& sigma, double seen, double least) {
    sigma = std::max(least, std::sqrt(kMemory * sigma * sigma + (1.0 - kMemory) * seen * seen));
  };
  follow(acceleration_, distance_m(expected, believed) / time2, kLeastAcceleration);
  follow(turn_acceleration_, turn_rad(expected, believed) / time2, kLeastTurnAcceleration);
}

}  // namespace voxlist::matching
