#include "tests/soak/laps.h"

#include <cmath>
#include <variant>

namespace voxlist::soak {
namespace {

using simulation::SimulatedEvent, simulation::SimulatedOdometry, simulation::SimulatedTruth;

// The laser turns this often a second: then a lap of whole seconds has whole lines.
constexpr double kTurnsPerSecond = 75.0;

// The mirror is where it was after two sweeps of a second each.
constexpr double kMirrorTurn_s = 2.0;

// Wheels tell so often a second, as a slow robot base's do.
constexpr double kOdometry_hz = 20.0;

simulation::SimulationConfig lap(const LapsConfig& config, double wait_s) {
  simulation::SimulationConfig lap;
  lap.scans = simulation::SimulationConfig::Scans::kLines;
  lap.seed = config.seed;
  lap.building.rooms = config.rooms;
  lap.building.seed = config.building_seed;
  lap.people.count = config.people;
  lap.odometry.rate_hz = kOdometry_hz;
  lap.drive.wait_s = wait_s;
  lap.scanner.turns_per_second = kTurnsPerSecond;
  const double tour_s = simulation::SimulatedRun(lap).truth().duration_s();
  lap.duration_s = kMirrorTurn_s * std::ceil(tour_s / kMirrorTurn_s);
  return lap;
}

std::unique_ptr<simulation::SimulatedRun> make_run(const LapsConfig& config, double wait_s) {
  return std::make_unique<simulation::SimulatedRun>(lap(config, wait_s));
}

std::int64_t in_us(double time_s) { return std::llround(time_s * 1e6); }

// When an event is, and the same event later.
template <class Event>
std::int64_t& utime_us(Event& event) {
  return event.utime_us;
}
std::int64_t& utime_us(SimulatedOdometry& event) { return event.measured.utime_us; }
std::int64_t& utime_us(SimulatedTruth& event) { return event.pose.utime_us; }

}  // namespace

Laps::Laps(const LapsConfig& config)
    : config_(config), run_(make_run(config, static_cast<double>(kStand_us) * 1e-6)) {}

SimulatedEvent Laps::next() {
  for (;;) {
    std::optional<SimulatedEvent> event = run_->next();
    const auto time = [](auto& e) -> std::int64_t& { return utime_us(e); };
    // What is at the lap's end is the next lap's first.
    if (!event || std::visit(time, *event) >= in_us(run_->duration_s())) {
      begin_next_lap();
      continue;
    }
    if (std::holds_alternative<simulation::SimulatedClockEdge>(*event)) continue;
    std::visit(time, *event) += start_us_;
    if (auto* odometry = std::get_if<SimulatedOdometry>(&*event))
      odometry->measured.pose = T_odom_start_ * odometry->measured.pose;
    return std::move(*event);
  }
}

void Laps::begin_next_lap() {
  start_us_ += in_us(run_->duration_s());
  T_odom_start_ = T_odom_start_ * run_->odometry().at(run_->duration_s());
  ++config_.seed;
  ++done_;
  run_ = make_run(config_, 0.0);
}

}  // namespace voxlist::soak
