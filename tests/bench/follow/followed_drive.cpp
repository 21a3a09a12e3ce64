#include "tests/bench/follow/followed_drive.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <vector>

#include "tests/bench/follow/robots_eyes.h"
#include "tests/clients/follower.h"
#include "voxlist/simulation/random.h"
#include "voxlist/simulation/world/path_planner.h"
#include "voxlist/simulation/world/people.h"

namespace voxlist::bench {
namespace {

constexpr double kTick_s = 0.02;
// The robot: its radius and height, what its motors and brakes do.
constexpr double kRadius_m = 0.3, kLow_m = 0.1, kHigh_m = 1.0;
constexpr double kSpeedsUp_mps2 = 0.8, kBrakes_mps2 = 1.1, kMoves_mps = 0.01;
// Points of the way are so far apart.
constexpr double kWaypoint_m = 0.4;
constexpr std::size_t kFewestPoints = 60;  // 6 m
// Somebody steps in so far ahead, from so far beside the way.
constexpr double kAhead_m = 2.0, kBeside_m = 0.75, kWalks_mps = 1.2, kStands_s = 2.0;
// More room than the robot's own is left by the way itself.
constexpr simulation::TourConfig kRoom{kRadius_m, 0.15, kHigh_m, 0.1};

std::vector<Eigen::Vector2d> random_way(const simulation::Building& building,
                                        simulation::Random& random) {
  const simulation::PathPlanner planner(building, kRoom);
  const auto room = [&] { return building.rooms[random.bits() % building.rooms.size()].centre(); };
  for (int i = 0; i < 100; ++i) {
    const auto way = planner.path(room(), room());
    if (way.size() > kFewestPoints) return way;
  }
  throw std::runtime_error("no way in this building");
}

std::vector<Follower::Point> points_of(const std::vector<Eigen::Vector2d>& way) {
  std::vector<Follower::Point> points;
  const auto step = static_cast<std::size_t>(kWaypoint_m / kRoom.cell_m);
  for (std::size_t i = step; i < way.size(); i += step) points.emplace_back(way[i].x(), way[i].y());
  points.emplace_back(way.back().x(), way.back().y());
  return points;
}

// Somebody who crosses the way of a robot that was at `robot` then, stands before it a while, and
// goes on to where the building ends it.
class Passer {
 public:
  // Nobody comes out of a wall, or steps in where the robot could not see it.
  static std::optional<Passer> before(const Pose2& robot, double t_s, double side,
                                      const simulation::Building& building) {
    const auto room_m = [&](double ahead_m, double aside_m) {
      const Pose2 place = robot * Pose2{ahead_m, aside_m, 0.0};
      return building.clearance_m({place.x_m, place.y_m}, kLow_m, kPerson_m);
    };
    for (double ahead_m = 0.0; ahead_m < kAhead_m; ahead_m += kStep_m)
      if (room_m(ahead_m, 0.0) < kStep_m) return std::nullopt;
    double to_m = kBeside_m;
    while (to_m > -kLeaves_m && room_m(kAhead_m, side * to_m) > kNeeds_m) to_m -= kStep_m;
    if (to_m > -kBeside_m) return std::nullopt;
    return Passer(robot, t_s, side, to_m + kStep_m);
  }

  Pose2 at(double t_s) const {
    const double walked_s = t_s - from_s_, to_way_s = kBeside_m / kWalks_mps;
    const double along_s =
        std::min(walked_s, to_way_s) + std::max(0.0, walked_s - to_way_s - kStands_s);
    return robot_ * Pose2{kAhead_m, side_ * std::max(to_m_, kBeside_m - kWalks_mps * along_s),
                          -side_ * std::numbers::pi / 2.0};
  }

  bool is_gone(double t_s) const { return t_s > from_s_ + kStands_s + 4.0; }

 private:
  static constexpr double kStep_m = 0.1, kPerson_m = 1.75, kNeeds_m = 0.25, kLeaves_m = 5.0;

  Passer(const Pose2& robot, double t_s, double side, double to_m)
      : robot_(robot), from_s_(t_s), side_(side), to_m_(to_m) {}

  Pose2 robot_;
  double from_s_, side_, to_m_;
};

double gap_to(const simulation::Building& building, const std::vector<Pose2>& people,
              const Eigen::Vector2d& robot) {
  double gap_m = building.clearance_m(robot, kLow_m, kHigh_m);
  for (const Pose2& person : people)
    for (const simulation::Box& box : simulation::person_at(person))
      if (box.bottom_m() < kHigh_m) gap_m = std::min(gap_m, box.distance_m(robot));
  return gap_m - kRadius_m;
}

voxlist::pose_t to_message(const Pose2& pose, std::int64_t utime_us) {
  voxlist::pose_t message{};
  message.utime = utime_us;
  message.pos[0] = pose.x_m;
  message.pos[1] = pose.y_m;
  message.orientation[0] = std::cos(pose.yaw_rad / 2.0);
  message.orientation[3] = std::sin(pose.yaw_rad / 2.0);
  return message;
}

bool has_drop(const obstacles_t& obstacles) {
  const auto type = static_cast<std::size_t>(planning::ObstacleType::kNegative);
  return std::ranges::any_of(obstacles.nearest_m[type],
                             [](float nearest_m) { return std::isfinite(nearest_m); });
}

class Drive {
 public:
  explicit Drive(const FollowedDriveConfig& config)
      : config_(config),
        random_(4717, static_cast<std::uint64_t>(config.seed)),
        building_(simulation::make_building({.seed = config.seed})),
        way_(random_way(building_, random_)),
        follower_(points_of(way_), config.laser == FollowersLaser::kMirror ? 1.0 : 0.1),
        eyes_(config.laser, static_cast<std::uint64_t>(config.seed)) {
    const Eigen::Vector2d ahead = way_[4] - way_[0];
    pose_ = {way_[0].x(), way_[0].y(), std::atan2(ahead.y(), ahead.x())};
    next_passer_m_ = config.step_in_every_m > 0.0 ? random_.uniform(0.5, config.step_in_every_m)
                                                  : std::numeric_limits<double>::infinity();
  }

  FollowedDriveResult run() {
    while (!result_.arrived && t_s_ < config_.longest_s) tick();
    result_.seconds = t_s_;
    return result_;
  }

 private:
  void tick() {
    t_s_ += kTick_s;
    eyes_.move(t_s_, pose_);
    const std::vector<Pose2> people = people_now();
    if (auto obstacles = eyes_.look(building_, people)) {
      ++result_.looks;
      result_.looks_with_drop += has_drop(*obstacles);
      if (t_s_ >= config_.blind_from_s) obstacles->blind = "the lens is covered";
      if (t_s_ < config_.silent_from_s) follower_.take(*obstacles);
    }
    const auto now_us = static_cast<std::int64_t>(std::llround(t_s_ * 1e6));
    follower_.take(to_message(pose_, now_us));
    const Command command = follower_.command(now_us);
    result_.arrived = command.why_not == "it is there";
    move(command);
    judge(people);
  }

  std::vector<Pose2> people_now() {
    if (result_.way_m >= next_passer_m_) {
      const double side = random_.uniform(-1.0, 1.0) < 0.0 ? -1.0 : 1.0;
      if (const auto passer = Passer::before(pose_, t_s_, side, building_)) {
        passer_ = passer;
        ++result_.stepped_in;
        next_passer_m_ += config_.step_in_every_m;
      }
    }
    if (passer_ && passer_->is_gone(t_s_)) passer_.reset();
    return passer_ ? std::vector<Pose2>{passer_->at(t_s_)} : std::vector<Pose2>{};
  }

  void move(const Command& command) {
    speed_mps_ += std::clamp(command.speed_mps - speed_mps_, -kBrakes_mps2 * kTick_s,
                             kSpeedsUp_mps2 * kTick_s);
    pose_ = pose_ * Pose2{speed_mps_ * kTick_s, 0.0, command.turn_radps * kTick_s};
    result_.way_m += speed_mps_ * kTick_s;
  }

  void judge(const std::vector<Pose2>& people) {
    if (speed_mps_ < kMoves_mps) return;
    const double gap_m = gap_to(building_, people, {pose_.x_m, pose_.y_m});
    result_.nearest_m = std::min(result_.nearest_m, gap_m);
    result_.touched |= gap_m <= 0.0;
    const double unseen_s = t_s_ - std::min(config_.silent_from_s, config_.blind_from_s);
    result_.stood_after_s = std::max(result_.stood_after_s, unseen_s);
  }

  const FollowedDriveConfig config_;
  simulation::Random random_;
  const simulation::Building building_;
  const std::vector<Eigen::Vector2d> way_;
  Follower follower_;
  RobotsEyes eyes_;
  FollowedDriveResult result_;
  Pose2 pose_;
  double t_s_ = 0.0, speed_mps_ = 0.0, next_passer_m_ = 0.0;
  std::optional<Passer> passer_;
};

}  // namespace

FollowedDriveResult follow(const FollowedDriveConfig& config) { return Drive(config).run(); }

}  // namespace voxlist::bench
