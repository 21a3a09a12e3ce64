#include "tests/bench/drives/twin_drive.h"

#include <cmath>
#include <numbers>

#include "voxlist/simulation/random.h"

namespace voxlist::bench {
namespace {

constexpr double kStep_m = 1.0, kScale = 0.02, kTurn_rad = std::numbers::pi / 180.0;
constexpr std::size_t kBlind = 8;

// From office to office, the middle of each, and back along the corridor.
std::vector<Eigen::Vector2d> goals_of(const simulation::Building& building) {
  std::vector<Eigen::Vector2d> goals{{0.0, 0.0}};
  for (const simulation::Room& room : building.rooms) {
    const Eigen::Vector2d corridor(room.door.x(), 0.0);
    for (const Eigen::Vector2d& goal : {corridor, room.door, room.centre(), room.door, corridor})
      goals.push_back(goal);
  }
  goals.emplace_back(0.0, 0.0);
  return goals;
}

// Looks where it drives, also out of an office.
std::vector<Pose2> way_of(const std::vector<Eigen::Vector2d>& goals) {
  std::vector<Pose2> way;
  double left_m = 0.0;
  for (std::size_t i = 1; i < goals.size(); ++i) {
    const Eigen::Vector2d leg = goals[i] - goals[i - 1];
    const double length_m = leg.norm(), yaw_rad = std::atan2(leg.y(), leg.x());
    for (; left_m < length_m; left_m += kStep_m) {
      const Eigen::Vector2d at = goals[i - 1] + leg * (left_m / length_m);
      way.push_back({at.x(), at.y(), yaw_rad});
    }
    left_m -= length_m;
  }
  return way;
}

}  // namespace

simulation::Building twin_offices(int rooms, int seed) {
  simulation::BuildingConfig config;
  config.rooms = rooms;
  config.length_m = 2.0 * rooms;
  config.seed = seed;
  config.alike = seed;
  return simulation::make_building(config);
}

TwinDrive twin_drive(const simulation::Building& building, bool blind, int seed) {
  simulation::Random random(static_cast<std::uint64_t>(seed), 9);
  TwinDrive drive;
  drive.truth = way_of(goals_of(building));
  drive.T_odom_base = {drive.truth.front()};
  const double scale = 1.0 + (random.uniform(0.0, 1.0) < 0.5 ? kScale : -kScale);
  for (std::size_t i = 1; i < drive.truth.size(); ++i) {
    Pose2 step = drive.truth[i - 1].inverse() * drive.truth[i];
    step = {scale * step.x_m, scale * step.y_m, step.yaw_rad + kTurn_rad * random.normal()};
    drive.T_odom_base.push_back(drive.T_odom_base.back() * step);
  }
  for (std::size_t i = 0; blind && i < kBlind; ++i) drive.blind.insert(drive.truth.size() / 2 + i);
  return drive;
}

}  // namespace voxlist::bench
