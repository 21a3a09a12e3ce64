#include "services/simulator/simulator_service.h"

#include <variant>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_t.hpp>

#include "bus/bus.h"
#include "bus/convert.h"
#include "bus/health.h"

namespace voxlist {
namespace {

template <class... Handlers>
struct Overloaded : Handlers... {
  using Handlers::operator()...;
};

std::int64_t utime_us(const SimulatedEvent& event) {
  return std::visit(Overloaded{[](const SimulatedOdometry& e) { return e.measured.utime_us; },
                               [](const SimulatedTruth& e) { return e.pose.utime_us; },
                               [](const auto& e) { return e.utime_us; }},
                    event);
}

}  // namespace

SimulatorService::SimulatorService(Bus& bus, Health& health, const SimulatorConfig& config)
    : bus_(bus),
      health_(health),
      speed_(config.speed),
      run_(config.simulation),
      next_(run_.next()) {}

void SimulatorService::tick(std::int64_t now_us) {
  if (!start_us_) start_us_ = now_us;
  const double run_us = speed_ * static_cast<double>(now_us - *start_us_);
  while (next_ && static_cast<double>(utime_us(*next_)) <= run_us) {
    publish(*next_);
    next_ = run_.next();
    if (!next_) health_.set_state(Health::State::kOk, "the tour is over");
  }
}

void SimulatorService::publish(const SimulatedEvent& event) {
  const auto publish_pose = [this](Channel<pose_t> channel, StampedPose2 pose) {
    pose.utime_us += *start_us_;
    bus_.publish(channel, to_message(pose));
  };
  const auto publish_cloud = [this](const Cloud& cloud) {
    pointcloud_t message = to_message(cloud, "base", clouds_++);
    message.utime += *start_us_;
    bus_.publish(kCloud, message);
  };
  std::visit(Overloaded{[&](const SimulatedOdometry& e) { publish_pose(kOdometry, e.measured); },
                        [&](const SimulatedTruth& e) { publish_pose(kTruth, e.pose); },
                        publish_cloud, [](const auto&) {}},
             event);
}

}  // namespace voxlist
