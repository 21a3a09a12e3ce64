#include "voxlist/matching/motion/motion_guess.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace voxlist::matching {
namespace {

// The last step goes on but for what the robot's speed and turn rate change by, as a standard
// deviation: at least so much (m/s^2, rad/s^2), more where lately it was more.
constexpr double kLeastAcceleration = 0.1, kLeastTurnAcceleration = 0.1;
// What the robot's last changes of speed count for, beside the newest one.
constexpr double kMemory = 0.8;
constexpr double kSteady_m = 0.02, kSteady_rad = 0.02;

// A step says nothing of a time that is so many times as long.
constexpr double kLongestGuess = 5.0;

// Steps in time count as at least so long (s): two clouds may come together.
constexpr double kShortestStep_s = 0.1;

// The farthest that a robot goes is so many standard deviations of a motion that nothing tells.
constexpr double kReachSigmas = 3.0;

Eigen::Matrix3d diagonal(double sigma_m, double sigma_rad) {
  return Eigen::Vector3d(sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad).asDiagonal();
}

double sigma_m(const UncertainPose& pose) {
  return std::sqrt(pose.covariance.topLeftCorner<2, 2>().trace());
}

}  // namespace

// A guess's errors go on from step to step: what one was off, the next is off as well. So errors
// add up, not their squares.
UncertainPose MotionGuess::pose(const UncertainPose& last, double dt_s) const {
  const UncertainPose step = motion(std::max(dt_s, kShortestStep_s));
  UncertainPose guess = last * step;
  const double before = sigma_m(last), now = sigma_m(step);
  const Eigen::Matrix3d own = guess.covariance - (last * UncertainPose{step.pose}).covariance;
  if (before > 0.0)
    guess.covariance = (1.0 + now / before) * (guess.covariance - own) + (1.0 + before / now) * own;
  return guess;
}

UncertainPose MotionGuess::anywhere(const UncertainPose& last, double dt_s) const {
  return last * unknown_motion(std::max(dt_s, kShortestStep_s));
}

UncertainPose MotionGuess::motion(double dt_s) const {
  UncertainPose unknown = unknown_motion(dt_s);
  if (!step_ || step_s_ <= 0.0 || dt_s > kLongestGuess * step_s_) return unknown;
  const double share = dt_s / step_s_;
  const UncertainPose goes_on{
      part_of(step_->pose, share),
      share * share * step_->covariance + diagonal(kSteady_m + acceleration_ * dt_s * dt_s,
                                                   kSteady_rad + turn_acceleration_ * dt_s * dt_s)};
  return goes_on.covariance(0, 0) < unknown.covariance(0, 0) ? goes_on : unknown;
}

UncertainPose MotionGuess::unknown_motion(double dt_s) const {
  return {{},
          diagonal(limits_.speed_mps * dt_s / kReachSigmas,
                   std::min(limits_.turn_rate_radps * dt_s, std::numbers::pi) / kReachSigmas)};
}

void MotionGuess::learn(const UncertainPose& last, const UncertainPose& now, double dt_s,
                        bool guessed) {
  const Eigen::Matrix3d covariance =
      guessed ? told_of_step(last, now, dt_s) : (last.covariance + now.covariance).eval();
  if (guessed && step_) learn_changes(pose(last, dt_s).pose, now.pose, dt_s);
  step_ = UncertainPose{last.pose.inverse() * now.pose, covariance};
  step_s_ = dt_s;
}

// What the match told of the pose beside the guess, it told of the step.
Eigen::Matrix3d MotionGuess::told_of_step(const UncertainPose& last, const UncertainPose& now,
                                          double dt_s) const {
  const UncertainPose guess = pose(last, dt_s), way = motion(std::max(dt_s, kShortestStep_s));
  const Eigen::Matrix3d told = guess.covariance.llt().matrixL().solve(Eigen::Matrix3d::Identity());
  const Eigen::Matrix3d to_step = Eigen::Matrix3d(way.covariance.llt().matrixL()) * told;
  return to_step * now.covariance * to_step.transpose();
}

void MotionGuess::learn_changes(const Pose2& guess, const Pose2& pose, double dt_s) {
  const double time2 = std::max(dt_s * dt_s, kShortestStep_s * kShortestStep_s);
  const auto follow = [](double& sigma, double now, double least) {
    sigma = std::max(least, std::sqrt(kMemory * sigma * sigma + (1.0 - kMemory) * now * now));
  };
  follow(acceleration_, distance_m(guess, pose) / time2, kLeastAcceleration);
  follow(turn_acceleration_, turn_rad(guess, pose) / time2, kLeastTurnAcceleration);
}

}  // namespace voxlist::matching
