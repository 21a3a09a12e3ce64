// A robot that follows a way and stops in time, as its author would write it: from POSE and
// OBSTACLES alone. follower.py is the same in Python.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>
#include <voxlist/obstacles_t.hpp>
#include <voxlist/pose_t.hpp>

struct Command {
  double speed_mps = 0.0, turn_radps = 0.0;
  std::string why_not = {};  // it does not drive
};

class Follower {
 public:
  using Point = std::pair<double, double>;

  explicit Follower(std::vector<Point> way) : way_(std::move(way)) {}

  void take(const voxlist::pose_t& pose) { pose_ = pose; }
  void take(const voxlist::obstacles_t& obstacles) { obstacles_ = obstacles; }

  Command command(std::int64_t now_us) {
    if (std::abs(now_us - pose_.utime) > kOldest_us) return {.why_not = "POSE is old"};
    if (std::abs(now_us - obstacles_.utime) > kOldest_us) return {.why_not = "OBSTACLES are old"};
    if (!obstacles_.blind.empty()) return {.why_not = "blind: " + obstacles_.blind};
    if (obstacles_.ground_seen_to_m.empty()) return {.why_not = "nothing was seen"};
    while (next_ < way_.size() && std::hypot(ahead().first, ahead().second) < kThere_m) ++next_;
    if (next_ == way_.size()) return {.why_not = "it is there"};
    const double aside = std::atan2(ahead().second, ahead().first);
    const double turn = std::clamp(2.0 * aside, -1.0, 1.0);
    if (std::abs(aside) > kAside_rad) return {0.0, turn};
    const double age_s = 1e-6 * static_cast<double>(now_us - obstacles_.utime);
    const double speed = std::min(safe_speed_mps(gap_m(), kReaction_s + age_s),
                                  kTopSpeed_mps * (1.0 - std::abs(aside) / kAside_rad));
    if (speed < kSlowest_mps) return {.why_not = "the way is not free"};
    return {speed, turn};
  }

 private:
  static constexpr double kRadius_m = 0.3, kMargin_m = 0.1, kBeside_m = 0.05, kTopSpeed_mps = 1.0,
                          kSlowest_mps = 0.02, kBrakes_mps2 = 1.0, kReaction_s = 0.2,
                          kThere_m = 0.2, kAside_rad = 0.5, kForesight_s = 1.0;
  static constexpr std::int64_t kOldest_us = 300'000;

  // The next point of the way, as the robot sees it.
  Point ahead() const {
    const double yaw = 2.0 * std::atan2(pose_.orientation[3], pose_.orientation[0]);
    const double x = way_[next_].first - pose_.pos[0], y = way_[next_].second - pose_.pos[1];
    return {std::cos(yaw) * x + std::sin(yaw) * y, std::cos(yaw) * y - std::sin(yaw) * x};
  }

  // How far the robot can go straight on: up to what stands, hangs or gapes, and no farther than
  // the floor was seen.
  double gap_m() const {
    double gap_m = std::numeric_limits<double>::infinity();
    const auto block = [&](double x, double y, double radius_m) {
      if (x > 0.0 && std::abs(y) < kRadius_m + kBeside_m + radius_m)
        gap_m = std::min(gap_m, x - radius_m - kRadius_m - kMargin_m);
    };
    for (std::size_t i = 0; i < obstacles_.ground_seen_to_m.size(); ++i) {
      double reach_m = obstacles_.ground_seen_to_m[i];
      for (const std::vector<float>& nearest_m : obstacles_.nearest_m)
        reach_m = std::min(reach_m, static_cast<double>(nearest_m[i]));
      const double bearing = obstacles_.rad0 + obstacles_.radstep * static_cast<double>(i);
      block(reach_m * std::cos(bearing), reach_m * std::sin(bearing), 0.0);
    }
    for (const voxlist::moving_obstacle_t& m : obstacles_.moving)
      block(m.position[0] + kForesight_s * m.velocity[0],
            m.position[1] + kForesight_s * m.velocity[1], m.radius_m);
    return std::max(0.0, gap_m);
  }

  // From this speed it stands before the gap is used up, though it notices late.
  static double safe_speed_mps(double gap_m, double late_s) {
    const double lost_mps = kBrakes_mps2 * late_s;
    return std::sqrt(lost_mps * lost_mps + 2.0 * kBrakes_mps2 * gap_m) - lost_mps;
  }

  const std::vector<Point> way_;
  std::size_t next_ = 0;
  voxlist::pose_t pose_{};
  voxlist::obstacles_t obstacles_{};
};
