// A robot that follows a way and stops in time, as its author would write it: from POSE and
// OBSTACLES, by the library's safe speed. follower.py is the same in Python, with a rule of its
// own.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>
#include <voxlist/obstacles_t.hpp>
#include <voxlist/pose_t.hpp>

#include "voxlist/planning/stopping/safe_speed.h"

struct Command {
  double speed_mps = 0.0, turn_radps = 0.0;
  std::string why_not = {};  // it does not drive
};

class Follower {
 public:
  using Point = std::pair<double, double>;

  // `sweep_s`: the scanner looks at one place once in this time.
  explicit Follower(std::vector<Point> way, double sweep_s = 1.0) : way_(std::move(way)) {
    around_.sweep_s = sweep_s;
  }

  void take(const voxlist::pose_t& pose) { pose_ = pose; }

  void take(const voxlist::obstacles_t& obstacles) {
    utime_us_ = obstacles.utime;
    blind_ = obstacles.blind;
    around_.things.clear();
    around_.ground_seen_to_m = obstacles.ground_seen_to_m;
    around_.step_rad = obstacles.radstep;
    for (const std::vector<float>& nearest_m : obstacles.nearest_m)
      for (std::size_t i = 0; i < nearest_m.size(); ++i)
        if (std::isfinite(nearest_m[i]))
          around_.things.push_back({nearest_m[i] * direction(obstacles, i)});
    for (const voxlist::moving_obstacle_t& m : obstacles.moving)
      around_.things.push_back(
          {{m.position[0], m.position[1]}, m.radius_m, {m.velocity[0], m.velocity[1]}, kWalks_mps});
  }

  Command command(std::int64_t now_us) {
    if (std::abs(now_us - pose_.utime) > kOldest_us) return {.why_not = "POSE is old"};
    if (std::abs(now_us - utime_us_) > kOldest_us) return {.why_not = "OBSTACLES are old"};
    if (!blind_.empty()) return {.why_not = "blind: " + blind_};
    if (around_.ground_seen_to_m.empty()) return {.why_not = "nothing was seen"};
    while (next_ < way_.size() && std::hypot(ahead().first, ahead().second) < kThere_m) ++next_;
    if (next_ == way_.size()) return {.why_not = "it is there"};
    const double aside = std::atan2(ahead().second, ahead().first);
    const double turn = std::clamp(2.0 * aside, -1.0, 1.0);
    if (std::abs(aside) > kAside_rad) return {0.0, turn};
    around_.age_s = 1e-6 * static_cast<double>(now_us - utime_us_);
    const double speed = std::min(voxlist::planning::safe_speed_mps(around_, turn, robot_),
                                  robot_.top_speed_mps * (1.0 - std::abs(aside) / kAside_rad));
    if (speed < kSlowest_mps) return {0.0, turn, "the way is not free"};
    return {speed, turn};
  }

 private:
  static constexpr double kSlowest_mps = 0.02, kThere_m = 0.2, kAside_rad = 0.5, kWalks_mps = 1.2;
  static constexpr std::int64_t kOldest_us = 300'000;

  static Eigen::Vector2d direction(const voxlist::obstacles_t& obstacles, std::size_t sector) {
    const double bearing = obstacles.rad0 + obstacles.radstep * static_cast<double>(sector);
    return {std::cos(bearing), std::sin(bearing)};
  }

  // The next point of the way, as the robot sees it.
  Point ahead() const {
    const double yaw = 2.0 * std::atan2(pose_.orientation[3], pose_.orientation[0]);
    const double x = way_[next_].first - pose_.pos[0], y = way_[next_].second - pose_.pos[1];
    return {std::cos(yaw) * x + std::sin(yaw) * y, std::cos(yaw) * y - std::sin(yaw) * x};
  }

  const std::vector<Point> way_;
  const voxlist::planning::StoppingRobot robot_;
  voxlist::planning::Surroundings around_;
  std::size_t next_ = 0;
  voxlist::pose_t pose_{};
  std::int64_t utime_us_ = 0;
  std::string blind_;
};
