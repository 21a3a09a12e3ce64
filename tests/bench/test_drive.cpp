#include "tests/bench/test_drive.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "voxlist/simulation/building/floor_plan.h"
#include "voxlist/simulation/world/robot.h"

namespace voxlist::bench {
namespace {

using Eigen::Vector2d;
using Path = std::vector<Vector2d>;

constexpr double kLength_m = 5.0;
constexpr double kRunOut_m = 0.3;  // of the way, so that it is not at its end yet
constexpr double kFirstScan_s = 1.0;
constexpr int kScans = 10;
constexpr double kClear_m = 0.4;          // on both sides of a leg within a room
constexpr double kPersonFromWay_m = 0.7;  // of whoever stands beside it

double length_m(const Path& path) {
  double length = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) length += (path[i] - path[i - 1]).norm();
  return length;
}

double distance_m(const Path& path, const Vector2d& point) {
  double nearest = (path.front() - point).norm();
  for (std::size_t i = 1; i < path.size(); ++i) {
    const Vector2d leg = path[i] - path[i - 1];
    const double share = (point - path[i - 1]).dot(leg) / std::max(1e-9, leg.squaredNorm());
    const Vector2d foot = path[i - 1] + std::clamp(share, 0.0, 1.0) * leg;
    nearest = std::min(nearest, (foot - point).norm());
  }
  return nearest;
}

bool is_free(const simulation::Building& building, const Vector2d& from, const Vector2d& to) {
  const int steps = 1 + static_cast<int>((to - from).norm() / 0.1);
  for (int i = 0; i <= steps; ++i)
    if (building.clearance_m(from + (to - from) * i / steps, 0.02, 1.0) < kClear_m) return false;
  return true;
}

// The middle lines of rooms, doors and corridors are free in every building.
class Ways {
 public:
  Ways(const TestFloor& floor, const simulation::Building& now, simulation::Random& random)
      : wing_(floor.config.wing), building_(now), random_(random) {
    const std::size_t room = random.bits() % now.rooms.size();
    room_ = now.rooms[room];
    corridor_y_ =
        static_cast<double>(room / static_cast<std::size_t>(wing_.rooms)) * wing_pitch_m(wing_);
  }

  Path of(DriveKind kind) {
    switch (kind) {
      case DriveKind::kRoom:
        return about_the_room();
      case DriveKind::kDoor:
        return through_the_door();
      case DriveKind::kCorridor:
        return along_the_corridor();
    }
    return {};
  }

 private:
  double corridor_low() const { return 0.0; }
  double corridor_high() const { return wing_.length_m - 1.0 - simulation::kWayHalfWidth_m; }
  Vector2d inside_the_door() const {
    return {room_.door.x(), room_.door.y() + std::copysign(simulation::kWayHalfWidth_m,
                                                           room_.door.y() - corridor_y_)};
  }

  Path along_the_corridor() {
    const double length = kLength_m + kRunOut_m;
    const double x = random_.uniform(corridor_low(), corridor_high() - length);
    Path path{{x, corridor_y_}, {x + length, corridor_y_}};
    return random_.bits() % 2 == 0 ? path : Path(path.rbegin(), path.rend());
  }

  Path through_the_door() {
    Path path{room_.centre(), inside_the_door(), {room_.door.x(), corridor_y_}};
    const double left = std::max(0.5, kLength_m + kRunOut_m - length_m(path));
    const bool up = room_.door.x() + left < corridor_high() &&
                    (room_.door.x() - left < corridor_low() || random_.bits() % 2 == 0);
    path.push_back({room_.door.x() + (up ? left : -left), corridor_y_});
    return random_.bits() % 2 == 0 ? path : Path(path.rbegin(), path.rend());
  }

  // Straight legs from one free place to another; from the middle to the door and back where there
  // are no others.
  Path about_the_room() {
    Path path{room_.centre()};
    for (int i = 0; i < 300 && length_m(path) < kLength_m + kRunOut_m; ++i) {
      const double x = random_.uniform(room_.low.x(), room_.high.x());
      const double y = random_.uniform(room_.low.y(), room_.high.y());
      const Vector2d to{x, y};
      if ((to - path.back()).norm() > 1.0 && is_free(building_, path.back(), to))
        path.push_back(to);
    }
    const Path back_and_forth{inside_the_door(), room_.centre()};
    if (path.size() == 1)
      for (int i = 0; length_m(path) < kLength_m + kRunOut_m && i < 20; ++i)
        path.push_back(back_and_forth[static_cast<std::size_t>(i) % 2]);
    return path;
  }

  const simulation::BuildingConfig& wing_;
  const simulation::Building& building_;
  simulation::Random& random_;
  simulation::Room room_;
  double corridor_y_;
};

std::vector<simulation::Trajectory> people_beside(const Path& path, int count,
                                                  simulation::Random& random) {
  constexpr int kTries = 1000;
  std::vector<simulation::Trajectory> people;
  for (int i = 0; i < kTries && std::ssize(people) < count; ++i) {
    const Vector2d& from = path[random.bits() % path.size()];
    const double x = from.x() + random.uniform(-3.0, 3.0), y = from.y() + random.uniform(-3.0, 3.0);
    const double yaw = random.uniform(-std::numbers::pi, std::numbers::pi);
    if (distance_m(path, {x, y}) > kPersonFromWay_m)
      people.emplace_back(1.0, std::vector<Pose2>{{x, y, yaw}});
  }
  return people;
}

// The robot's motion in the map: it begins along the first leg.
simulation::Trajectory drive_along(const Path& path) {
  const Vector2d first = path[1] - path[0];
  const Pose2 T_map_start{path[0].x(), path[0].y(), std::atan2(first.y(), first.x())};
  Path from_start;
  for (const Vector2d& point : path)
    from_start.push_back(
        (T_map_start.inverse() * Eigen::Vector3d(point.x(), point.y(), 0.0)).head<2>());
  simulation::DriveConfig config;
  config.wait_s = kFirstScan_s;
  const simulation::Trajectory driven = simulation::drive(from_start, config);
  std::vector<Pose2> poses;
  for (const Pose2& pose : driven.poses()) poses.push_back(T_map_start * pose);
  return simulation::Trajectory(driven.period_s(), std::move(poses));
}

// When so much has been driven.
double time_at(const simulation::Trajectory& truth, double driven_m) {
  const std::vector<Pose2>& poses = truth.poses();
  std::size_t i = 1;
  for (double driven = 0.0; i < poses.size() && driven < driven_m; ++i)
    driven += distance_m(poses[i - 1], poses[i]);
  return truth.period_s() * static_cast<double>(i - 1);
}

}  // namespace

std::vector<DriveStep> drive_through(const TestFloor& floor, const simulation::Building& now,
                                     DriveKind kind, int people, std::uint64_t seed) {
  simulation::Random random(seed, 901);
  const Path path = Ways(floor, now, random).of(kind);
  const simulation::World world(now, people_beside(path, people, random));
  const simulation::Trajectory truth = drive_along(path);
  const simulation::Trajectory odometry = simulation::wheel_odometry(truth, {}, seed);
  const simulation::MirrorScanner scanner(world, truth, {}, seed);
  const double period_s = (time_at(truth, kLength_m) - kFirstScan_s) / (kScans - 1);
  std::vector<DriveStep> steps;
  for (int i = 0; i < kScans; ++i) {
    const double t = kFirstScan_s + i * period_s;
    steps.push_back(
        {simulation::scan_sweep(scanner, odometry, t, {}, seed), truth.at(t), odometry.at(t)});
  }
  return steps;
}

}  // namespace voxlist::bench
