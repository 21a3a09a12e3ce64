#include "voxlist/simulation/world/people.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "voxlist/geometry/elementary.h"
#include "voxlist/simulation/random.h"
#include "voxlist/simulation/world/path_planner.h"

namespace voxlist::simulation {
namespace {

using Eigen::Vector2d;
using Path = std::vector<Vector2d>;

// Steps of a person's motion (s).
constexpr double kPeriod_s = 0.1;

// A person turns round this far from the robot (m), and a way that leads nearer than the second is
// not taken.
constexpr double kTurnRound_m = 1.0, kNeverNearer_m = 0.55;

// Ways that are tried for each person, and rooms that a way visits.
constexpr int kTries = 50, kRoomsVisited = 3;

// The room that a person needs.
constexpr TourConfig kRoom{0.25, 0.05, 1.8, 0.1};

// People's own stream of random numbers, so that they change nothing else.
constexpr std::uint64_t kStream = 201;

// A closed path through a few rooms; empty when a room cannot be reached.
Path closed_path(const PathPlanner& planner, const std::vector<Room>& rooms, Random& random) {
  std::vector<Vector2d> stops;
  for (int i = 0; i < kRoomsVisited; ++i)
    stops.push_back(rooms[random.bits() % rooms.size()].centre());
  stops.push_back(stops.front());
  Path path;
  for (std::size_t i = 1; i < stops.size(); ++i) {
    const Path leg = planner.path(stops[i - 1], stops[i]);
    if (leg.empty()) return {};
    path.insert(path.end(), leg.begin() + 1, leg.end());
  }
  return path;
}

// Someone on a closed path.
class Walker {
 public:
  explicit Walker(const Path& path) : path_(path), from_start_m_{0.0} {
    for (std::size_t i = 1; i <= path.size(); ++i)
      from_start_m_.push_back(from_start_m_.back() + (path[i % path.size()] - path[i - 1]).norm());
  }

  double length_m() const { return from_start_m_.back(); }

  void place(double along_m) { along_m_ = along_m; }

  // A step on; the other way round when that leads away from a robot that is near.
  Pose2 step(double distance_m, const Vector2d& robot) {
    const auto gap = [&](int direction) {
      return (at(along_m_ + direction * distance_m) - robot).norm();
    };
    if (gap(direction_) < kTurnRound_m && gap(-direction_) > gap(direction_))
      direction_ = -direction_;
    const Vector2d before = at(along_m_);
    along_m_ += direction_ * distance_m;
    const Vector2d now = at(along_m_), way = now - before;
    return {now.x(), now.y(), elementary::atan2(way.y(), way.x())};
  }

 private:
  Vector2d at(double along_m) const {
    along_m -= std::floor(along_m / length_m()) * length_m();
    const auto next = std::upper_bound(from_start_m_.begin() + 1, from_start_m_.end() - 1, along_m);
    const auto i = static_cast<std::size_t>(next - from_start_m_.begin());
    const double share = (along_m - from_start_m_[i - 1]) / (*next - from_start_m_[i - 1]);
    const Vector2d& a = path_[i - 1];
    return a + share * (path_[i % path_.size()] - a);
  }

  const Path& path_;
  std::vector<double> from_start_m_;  // of each point, and of the first again
  double along_m_ = 0.0;
  int direction_ = 1;
};

// Nothing when the robot comes too near all the same: it visits rooms that have but one door.
std::optional<Trajectory> walk_along(const Path& path, const Trajectory& robot, double duration_s,
                                     double speed_mps, Random& random) {
  if (path.size() < 2) return std::nullopt;
  Walker walker(path);
  walker.place(random.uniform(0.0, walker.length_m()));
  std::vector<Pose2> poses;
  for (double t = 0.0; t <= duration_s + kPeriod_s; t += kPeriod_s) {
    const Pose2 robot_pose = robot.at(t);
    poses.push_back(walker.step(speed_mps * kPeriod_s, {robot_pose.x_m, robot_pose.y_m}));
    if (distance_m(poses.back(), robot_pose) < kNeverNearer_m) return std::nullopt;
  }
  return Trajectory(kPeriod_s, std::move(poses));
}

}  // namespace

std::vector<Trajectory> walk(const Building& building, const Trajectory& robot, double duration_s,
                             const PeopleConfig& config, std::uint64_t seed) {
  std::vector<Trajectory> people;
  if (config.count == 0 || building.rooms.empty()) return people;
  const PathPlanner planner(building, kRoom);
  Random random(seed, kStream);
  const double walk_s = std::max(duration_s, robot.duration_s());
  for (int i = 0; i < config.count * kTries && std::ssize(people) < config.count; ++i) {
    const Path path = closed_path(planner, building.rooms, random);
    const auto person = walk_along(path, robot, walk_s, config.speed_mps, random);
    if (person) people.push_back(*person);
  }
  return people;
}

std::array<Box, 3> person_at(const Pose2& pose) {
  const auto part = [&pose](double from, double to, double deep, double wide) {
    return Box{{pose.x_m, pose.y_m, (from + to) / 2.0},
               {deep / 2.0, wide / 2.0, (to - from) / 2.0},
               pose.yaw_rad};
  };
  return {part(0.0, 0.85, 0.25, 0.32), part(0.85, 1.5, 0.25, 0.46), part(1.5, 1.75, 0.2, 0.16)};
}

}  // namespace voxlist::simulation
