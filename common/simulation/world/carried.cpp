#include "voxlist/simulation/world/carried.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace voxlist::simulation {
namespace {

// Fine enough for a robot that stands, and for one that is not there a moment later (s).
constexpr double kPeriod_s = 0.01;

std::size_t steps_to(double t_s) { return static_cast<std::size_t>(std::ceil(t_s / kPeriod_s)); }

// One pose for each step until the robot is carried off.
std::vector<Pose2> poses_before(const Trajectory& driven, const CarriedConfig& config) {
  std::vector<Pose2> poses;
  for (std::size_t i = 0; i <= steps_to(config.at_s.front()); ++i)
    poses.push_back(driven.at(static_cast<double>(i) * kPeriod_s));
  return poses;
}

// The rest of the way, from where it was interrupted.
void drive_on(const Trajectory& driven, const CarriedConfig& config, std::vector<Pose2>& poses) {
  if (config.back_at_s == 0.0) return;
  poses.resize(std::max(steps_to(config.back_at_s) + 1, poses.size()), poses.back());
  const std::size_t end = steps_to(driven.duration_s());
  for (std::size_t i = steps_to(config.at_s.front()); i <= end; ++i)
    poses.push_back(driven.at(static_cast<double>(i) * kPeriod_s));
}

void check(const CarriedConfig& config) {
  if (config.x_m.size() != config.at_s.size() || config.y_m.size() != config.at_s.size())
    throw std::invalid_argument("simulation: each time of being carried needs one x and one y");
  if (!std::ranges::is_sorted(config.at_s))
    throw std::invalid_argument("simulation: times of being carried must ascend");
  if (config.back_at_s == 0.0) return;
  if (config.at_s.empty() || config.back_at_s < config.at_s.back())
    throw std::invalid_argument("simulation: a robot is put back after it was carried off");
}

}  // namespace

Trajectory without_carries(const Trajectory& driven, const CarriedConfig& config) {
  check(config);
  if (config.at_s.empty()) return driven;
  std::vector<Pose2> poses = poses_before(driven, config);
  drive_on(driven, config, poses);
  return Trajectory(kPeriod_s, std::move(poses));
}

Trajectory with_carries(const Trajectory& driven, const CarriedConfig& config) {
  check(config);
  if (config.at_s.empty()) return driven;
  std::vector<Pose2> poses = poses_before(driven, config);
  for (std::size_t i = 0; i < config.at_s.size(); ++i) {
    const bool is_last = i + 1 == config.at_s.size();
    const std::size_t end = is_last ? poses.size() + 1 : steps_to(config.at_s[i + 1]) + 1;
    poses.resize(std::max(end, poses.size()), Pose2{config.x_m[i], config.y_m[i], 0.0});
  }
  drive_on(driven, config, poses);
  return Trajectory(kPeriod_s, std::move(poses));
}

}  // namespace voxlist::simulation
