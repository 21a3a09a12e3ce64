#include "services/mirror_monitor/mirror_monitor_service.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <voxlist/mirror_state_t.hpp>
#include <voxlist/planar_lidar_t.hpp>

#include "services/mirror_monitor/open_edge_source.h"
#include "voxlist/bus/bus.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/health.h"
#include "voxlist/geometry/mirror_state.h"

namespace voxlist::services {
namespace {

std::int64_t wall_us() {
  using namespace std::chrono;
  return duration_cast<microseconds>(system_clock::now().time_since_epoch()).count();
}

bus::Health::State how_bad(MirrorState::State state) {
  switch (state) {
    case MirrorState::State::kLocked:
      return bus::Health::State::kOk;
    case MirrorState::State::kStalled:
      return bus::Health::State::kError;
    case MirrorState::State::kFault:
    case MirrorState::State::kSearching:
      break;
  }
  return bus::Health::State::kWarning;
}

}  // namespace

MirrorMonitorService::MirrorMonitorService(bus::Bus& bus, bus::Health& health,
                                           const MirrorMonitorConfig& config)
    : MirrorMonitorService(bus, health, config, wall_us) {}

MirrorMonitorService::MirrorMonitorService(bus::Bus& bus, bus::Health& health,
                                           const MirrorMonitorConfig& config, WallClock wall_clock)
    : bus_(bus),
      health_(health),
      clock_(mirror_clock_config(config)),
      edges_(open_edge_source(config.clock, std::move(wall_clock))) {
  bus_.subscribe(bus::kLaser, [this](const planar_lidar_t& m) { take(m); });
}

void MirrorMonitorService::check(const MirrorMonitorConfig& config) {
  mirror_clock_config(config);
  open_edge_source(config.clock, wall_us);
}

void MirrorMonitorService::take(const planar_lidar_t& message) {
  const std::optional<LaserLine> line = bus::from_message(message);
  if (!line) return health_.count("LASER/bad_line");
  read_edges();
  last_ = clock_.add_line(*line);
  bus_.publish(bus::kMirror, bus::to_message(*last_));
  arrival_us_ = bus_.arrival_utime_us();
}

void MirrorMonitorService::read_edges() {
  if (!edges_) return;
  for (const std::int64_t utime_us : edges_->read(now_us_)) clock_.add_edge(utime_us);
}

void MirrorMonitorService::tick(std::int64_t now_us) {
  now_us_ = now_us;
  read_edges();
  if (arrival_us_) health_.add_latency_us(now_us - *arrival_us_);
  arrival_us_.reset();
  count();
  tell();
}

// HEALTH adds up; counts and measures here are given as they are.
void MirrorMonitorService::count() {
  const auto set = [this](const char* what, std::int64_t value) {
    std::int64_t& counted = counted_[what];
    if (value != counted || value == 0) health_.count(what, value - counted);
    counted = value;
  };
  const scanner::MirrorClock::Counts counts = clock_.counts();
  set("edges", counts.edges);
  set("lost_edges", counts.lost_edges);
  set("extra_edges", counts.extra_edges);
  set("clock_restarts", counts.clock_restarts);
  set("clock_garbage", edges_ ? edges_->garbage() : 0);
  set("clock_period_us", std::llround(clock_.clock_period_us()));
  set("arm_events", counts.arm_events);
  set("strange_arm_events", counts.strange_arm_events);
  set("missed_steps", counts.missed_steps);
  set("stalls", counts.stalls);
  set("time_jumps", counts.time_jumps);
  const double residual_rad = last_ ? last_->residual_rad : 0.0;
  set("residual_mdeg", std::llround(residual_rad * 180e3 / std::numbers::pi));
}

void MirrorMonitorService::tell() {
  using S = bus::Health::State;
  const std::string of_clock = edges_ ? edges_->trouble() : "";
  const std::string of_mirror = last_ ? last_->reason : "no LASER yet: does laser_driver run?";
  const S mirror = last_ ? how_bad(last_->state) : S::kWarning;
  // The device explains a mirror that is no worse than it: then its sentence is enough.
  const bool is_explained = !of_clock.empty() && mirror <= S::kWarning;
  health_.raise("clock", S::kWarning, of_clock);
  health_.raise("mirror", mirror, is_explained ? "" : of_mirror);
}

}  // namespace voxlist::services
