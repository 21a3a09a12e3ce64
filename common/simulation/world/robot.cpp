#include "voxlist/simulation/world/robot.h"

#include <algorithm>
#include <cmath>

#include "voxlist/geometry/angle.h"
#include "voxlist/geometry/elementary.h"
#include "voxlist/simulation/random.h"

namespace voxlist::simulation {
namespace {

using Eigen::Vector2d;
using Path = std::vector<Vector2d>;

// The robot has arrived within this (m) of its path's end, and is turned within this (rad).
constexpr double kArrived_m = 0.02, kAligned_rad = 0.01;

// Turn rate for a heading error (1/s), and the error (rad) above which the robot stops to turn.
constexpr double kTurnGain = 2.0, kTurnInPlace_rad = 60.0 * kRadPerDeg;

// No tour takes longer (s): bounds the loop.
constexpr double kLongest_s = 3600.0;

// A speed one step nearer to the wanted one, no faster than the acceleration allows.
double ramp(double now, double wanted, double step) {
  return now + std::clamp(wanted - now, -step, step);
}

class Driver {
 public:
  Driver(const Path& path, const DriveConfig& config) : path_(path), config_(config) {
    pose_ = {path.front().x(), path.front().y(), 0.0};
    left_m_.assign(path.size(), 0.0);
    for (std::size_t i = path.size() - 1; i > 0; --i)
      left_m_[i - 1] = left_m_[i] + (path[i] - path[i - 1]).norm();
  }

  std::vector<Pose2> run() {
    std::vector<Pose2> poses(1 + static_cast<std::size_t>(config_.wait_s / config_.period_s),
                             pose_);
    const auto most = static_cast<std::size_t>(kLongest_s / config_.period_s);
    while (poses.size() < most && !(arrived() && aligned())) {
      step();
      poses.push_back(pose_);
    }
    return poses;
  }

 private:
  Vector2d position() const { return {pose_.x_m, pose_.y_m}; }
  bool arrived() const {
    return (position() - path_.back()).norm() < kArrived_m && target_ + 1 == path_.size();
  }
  bool aligned() const { return std::abs(pose_.yaw_rad) < kAligned_rad; }

  // The farthest point of the path that is still within the lookahead, never going back.
  void advance_target() {
    while (target_ + 1 < path_.size() && (path_[target_] - position()).norm() < config_.lookahead_m)
      ++target_;
  }

  void step() {
    advance_target();
    const Vector2d to_target = path_[target_] - position();
    const double wanted_yaw = arrived() ? 0.0 : elementary::atan2(to_target.y(), to_target.x());
    const double error = wrap_angle(wanted_yaw - pose_.yaw_rad);
    const double facing = std::max(0.0, 1.0 - std::abs(error) / kTurnInPlace_rad);
    const double left = to_target.norm() + left_m_[target_];
    const double stoppable = std::sqrt(2.0 * config_.acceleration_max_mps2 * left);
    const double wanted_speed =
        arrived() ? 0.0 : facing * std::min(config_.speed_max_mps, 0.8 * stoppable);
    const double turn_max = config_.turn_rate_max_dps * kRadPerDeg;
    const double dt = config_.period_s;
    speed_ = ramp(speed_, wanted_speed, config_.acceleration_max_mps2 * dt);
    turn_ = ramp(turn_, std::clamp(kTurnGain * error, -turn_max, turn_max),
                 config_.turn_acceleration_max_dps2 * kRadPerDeg * dt);
    const double middle = pose_.yaw_rad + turn_ * dt / 2.0;
    const auto [s, c] = elementary::sine_cosine(middle);
    pose_ = {pose_.x_m + speed_ * dt * c, pose_.y_m + speed_ * dt * s,
             wrap_angle(pose_.yaw_rad + turn_ * dt)};
  }

  const Path& path_;
  const DriveConfig& config_;
  std::vector<double> left_m_;  // path left after each point
  std::size_t target_ = 0;
  Pose2 pose_;
  double speed_ = 0.0;  // m/s
  double turn_ = 0.0;   // rad/s
};

}  // namespace

Trajectory drive(const Path& path, const DriveConfig& config) {
  return Trajectory(config.period_s, Driver(path, config).run());
}

Trajectory wheel_odometry(const Trajectory& truth, const OdometryConfig& config,
                          std::uint64_t seed) {
  Random random(seed);
  const double distance_scale = 1.0 + config.distance_scale_sd * random.normal();
  const double turn_scale = 1.0 + config.turn_scale_sd * random.normal();
  const double period = 1.0 / config.rate_hz;
  const auto samples = static_cast<std::size_t>(std::ceil(truth.duration_s() / period));

  std::vector<Pose2> poses{Pose2{}};
  for (std::size_t i = 0; i < samples; ++i) {
    const double t = static_cast<double>(i) * period;
    const Pose2 step = truth.at(t).inverse() * truth.at(t + period);
    const double root = std::sqrt(elementary::hypot(step.x_m, step.y_m));
    const double x = distance_scale * step.x_m + config.distance_noise_m * root * random.normal();
    const double yaw =
        turn_scale * step.yaw_rad + config.heading_noise_deg * kRadPerDeg * root * random.normal();
    poses.push_back(poses.back() * Pose2{x, step.y_m, yaw});
  }
  return Trajectory(period, std::move(poses));
}

}  // namespace voxlist::simulation
