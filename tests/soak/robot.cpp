#include "tests/soak/robot.h"

#include <algorithm>
#include <utility>
#include <variant>
#include <voxlist/keyframe_t.hpp>
#include <voxlist/localisation_t.hpp>
#include <voxlist/mirror_state_t.hpp>
#include <voxlist/obstacles_t.hpp>
#include <voxlist/planar_lidar_t.hpp>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_t.hpp>

#include "voxlist/bus/convert.h"

namespace voxlist::soak {
namespace {

using Clock = std::chrono::steady_clock;

// When its first lap starts: what is played so fast is of no time of the wall clock.
constexpr std::int64_t kBegin_us = 1'700'000'000'000'000;

// Lines that may be out before MIRROR has come for them: so many find room in a socket of Debian's
// size, and scripts/soak has the assembler wait for them.
constexpr std::int64_t kLinesAhead = 40;

// The newest answer may be so old (us): two sweeps of 1 s on their way, and half of a third.
constexpr std::int64_t kAhead_us = 2'500'000;

// It waits so long for services, then it drives on: that is a fault, and is counted.
constexpr std::chrono::seconds kPatience(10);

// It stands so long, but for the last 3 s without ODOMETRY (us).
constexpr std::int64_t kSettle_us = 42'000'000;
static_assert(kSettle_us < Laps::kStand_us);

// Every service has said HEALTH after this.
constexpr std::chrono::milliseconds kHealth(2500);

// A cloud that has no answer by then (us, of its own time) has none.
constexpr std::int64_t kAnswered_us = 20'000'000;

template <class... Handlers>
struct Overloaded : Handlers... {
  using Handlers::operator()...;
};

double ms_since(Clock::time_point time) {
  return std::chrono::duration<double, std::milli>(Clock::now() - time).count();
}

}  // namespace

Robot::Robot(const LapsConfig& config, const std::vector<std::string>& services) : laps_(config) {
  for (const std::string& name : services) watches_[name];
  bus_.subscribe(bus::kHealth, [this](const health_t& message) {
    const auto watch = watches_.find(message.service);
    if (watch != watches_.end()) watch->second.take(message);
  });
  bus_.subscribe(bus::kMirror, [this](const mirror_state_t&) { ++mirrors_; });
  bus_.subscribe(bus::kObstacles,
                 [this](const obstacles_t& message) { obstacles_us_ = message.utime; });
  bus_.subscribe(bus::kCloud, [this](const pointcloud_t& message) {
    asked_.push_back({message.utime, Clock::now()});
  });
  bus_.subscribe(bus::kLocalisation, [this](const localisation_t& message) { take(message); });
  bus_.subscribe(bus::kKeyframe,
                 [this](const keyframe_t& message) { now_.keyframes = message.index + 1; });
}

template <class Condition>
void Robot::wait_until(Condition is_met) {
  const auto end = Clock::now() + kPatience;
  bus_.handle(std::chrono::milliseconds(0));
  while (!is_met()) {
    bus_.handle(std::chrono::milliseconds(10));
    if (Clock::now() < end) continue;
    ++now_.late;
    // What has not come by now is not waited for again.
    mirrors_ = lines_;
    answered_us_ = obstacles_us_ = 0;
    return;
  }
}

bool Robot::heard_all() const {
  for (const auto& [name, watch] : watches_)
    if (!watch.was_heard()) return false;
  return true;
}

bool Robot::meet_services(std::chrono::seconds most) {
  const auto end = Clock::now() + most;
  while (!heard_all() && Clock::now() < end) bus_.handle(std::chrono::milliseconds(20));
  for (auto& [name, watch] : watches_) watch.since_last();
  return heard_all();
}

void Robot::take(const localisation_t& message) {
  answered_us_ = message.utime;
  const auto asked = std::ranges::find(asked_, message.utime, &Asked::utime_us);
  if (asked == asked_.end()) return;
  now_.answers.answer_ms.push_back(ms_since(asked->since));
  asked_.erase(asked);
  if (message.state == localisation_t::STATE_LOST) ++now_.answers.lost;
  if (message.state == localisation_t::STATE_AMBIGUOUS) ++now_.answers.ambiguous;
  if (message.state != localisation_t::STATE_TRACKING) return;
  ++now_.answers.tracking;
  const double(&pose)[3] = message.modes.at(0).pose;
  const Pose2 told{pose[0], pose[1], pose[2]}, truth = truth_.at(message.utime);
  now_.answers.error_mm.push_back(distance_m(told, truth) * 1e3);
  now_.answers.wrong += distance_m(told, truth) > kWrong_m || turn_rad(told, truth) > kWrong_rad;
}

void Robot::give_up_old(std::int64_t utime_us) {
  now_.answers.unanswered += static_cast<int>(std::erase_if(
      asked_, [&](const Asked& asked) { return asked.utime_us < utime_us - kAnswered_us; }));
}

void Robot::settle() {
  drive_until(kBegin_us + kSettle_us - 3'000'000);
  is_settled_ = true;
  drive_until(kBegin_us + kSettle_us);
  const auto end = Clock::now() + kHealth;
  while (Clock::now() < end) bus_.handle(std::chrono::milliseconds(20));
  for (auto& [name, watch] : watches_) watch.since_last();
  now_ = {};
  begin_us_ = kBegin_us + kSettle_us;
}

Minute Robot::drive_minute() {
  const auto start = Clock::now();
  begin_us_ += 60'000'000;
  drive_until(begin_us_);
  give_up_old(begin_us_);
  for (auto& [name, watch] : watches_) now_.services[name] = watch.since_last();
  now_.wall_s = ms_since(start) * 1e-3;
  Minute minute = std::exchange(now_, {});
  now_.keyframes = minute.keyframes;
  return minute;
}

void Robot::drive_until(std::int64_t utime_us) {
  std::int64_t now_us = 0;
  do {
    const simulation::SimulatedEvent event = laps_.next();
    send(event);
    if (const auto* line = std::get_if<LaserLine>(&event)) now_us = kBegin_us + line->utime_us;
  } while (now_us < utime_us);
}

void Robot::send(const simulation::SimulatedEvent& event) {
  const auto later = [](StampedPose2 pose) {
    pose.utime_us += kBegin_us;
    return pose;
  };
  std::visit(Overloaded{[&](const simulation::SimulatedOdometry& e) {
                          if (is_settled_)
                            bus_.publish(bus::kOdometry, bus::to_message(later(e.measured)));
                        },
                        [&](const simulation::SimulatedTruth& e) {
                          const StampedPose2 pose = later(e.pose);
                          truth_.add(pose.utime_us, pose.pose);
                          bus_.publish(bus::kTruth, bus::to_message(pose));
                        },
                        [&](const LaserLine& line) { send_line(line); }, [](const auto&) {}},
             event);
}

void Robot::send_line(const LaserLine& line) {
  LaserLine sent = line;
  sent.utime_us += kBegin_us;
  wait_for_services(sent.utime_us);
  bus_.publish(bus::kLaser, bus::to_message(sent));
  ++lines_;
}

void Robot::wait_for_services(std::int64_t utime_us) {
  wait_until([&] {
    const auto is_behind = [&](std::int64_t newest_us) {
      return newest_us != 0 && newest_us < utime_us - kAhead_us;
    };
    return mirrors_ >= lines_ - kLinesAhead && !is_behind(answered_us_) &&
           !is_behind(obstacles_us_);
  });
}

}  // namespace voxlist::soak
