#include "services/simulator/simulator_service.h"

#include <sys/timerfd.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <variant>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_t.hpp>

#include "voxlist/bus/bus.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/health.h"

namespace voxlist::services {
namespace {

template <class... Handlers>
struct Overloaded : Handlers... {
  using Handlers::operator()...;
};

std::int64_t utime_us(const simulation::SimulatedEvent& event) {
  return std::visit(
      Overloaded{[](const simulation::SimulatedOdometry& e) { return e.measured.utime_us; },
                 [](const simulation::SimulatedTruth& e) { return e.pose.utime_us; },
                 [](const auto& e) { return e.utime_us; }},
      event);
}

enum class Output { kScanner, kCloud };

Output output_of(const SimulatorConfig& config) {
  if (config.output == "scanner") return Output::kScanner;
  if (config.output == "cloud") return Output::kCloud;
  throw std::invalid_argument("output must be \"scanner\" or \"cloud\"");
}

bool has_scanner(const SimulatorConfig& config) { return output_of(config) == Output::kScanner; }

SimulatorConfig checked(SimulatorConfig config) {
  if (has_scanner(config) && config.speed != 1.0)
    throw std::invalid_argument(
        "speed must be 1: the scanner's ports run in real time. For other speeds: output = "
        "\"cloud\"");
  LaserFaults{config.laser_fault};
  config.simulation.scans = has_scanner(config) ? simulation::SimulationConfig::Scans::kNothing
                                                : simulation::SimulationConfig::Scans::kClouds;
  return config;
}

}  // namespace

SimulatorService::SimulatorService(bus::Bus& bus, bus::Health& health,
                                   const SimulatorConfig& config)
    : bus_(bus),
      health_(health),
      config_(checked(config)),
      run_(config_.simulation),
      timer_(timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC)),
      next_(run_.next()) {}

void SimulatorService::check(const SimulatorConfig& config) {
  simulation::SimulatedRun{checked(config).simulation};
}

void SimulatorService::tick(std::int64_t now_us) {
  if (!start_us_) start(now_us);
  const double run_us = config_.speed * static_cast<double>(now_us - *start_us_);
  while (next_ && static_cast<double>(utime_us(*next_)) <= run_us) {
    publish(*next_);
    next_ = run_.next();
    if (!next_) health_.raise("end", bus::Health::State::kOk, "the tour is over");
  }
  wait_for_next(now_us);
}

void SimulatorService::start(std::int64_t now_us) {
  start_us_ = now_us;
  if (has_scanner(config_)) scanner_.emplace(run_.scanner(), config_, now_us);
}

void SimulatorService::wait_for_next(std::int64_t now_us) const {
  itimerspec when{};
  if (next_) {
    const double due_us = static_cast<double>(*start_us_ - now_us) +
                          static_cast<double>(utime_us(*next_)) / config_.speed;
    const std::int64_t wait_ns = std::max<std::int64_t>(1, std::llround(due_us * 1e3));
    when.it_value = {wait_ns / 1'000'000'000, wait_ns % 1'000'000'000};
  }
  timerfd_settime(timer_.get(), 0, &when, nullptr);
}

void SimulatorService::publish(const simulation::SimulatedEvent& event) {
  const auto publish_pose = [this](bus::Channel<pose_t> channel, StampedPose2 pose) {
    pose.utime_us += *start_us_;
    bus_.publish(channel, bus::to_message(pose));
  };
  const auto publish_cloud = [this](const Cloud& cloud) {
    pointcloud_t message = bus::to_message(cloud, "base", clouds_++);
    message.utime += *start_us_;
    bus_.publish(bus::kCloud, message);
  };
  std::visit(
      Overloaded{
          [&](const simulation::SimulatedOdometry& e) { publish_pose(bus::kOdometry, e.measured); },
          [&](const simulation::SimulatedTruth& e) { publish_pose(bus::kTruth, e.pose); },
          publish_cloud, [](const simulation::SimulatedClockEdge&) {}, [](const LaserLine&) {}},
      event);
}

}  // namespace voxlist::services
