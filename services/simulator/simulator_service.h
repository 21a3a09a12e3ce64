#pragma once

#include <cstdint>
#include <optional>

#include "simulation/simulated_run.h"

namespace voxlist {

class Bus;
class Health;

/// Settings of the simulator.
struct SimulatorConfig {
  double speed = 1.0;
  SimulationConfig simulation;

  template <class Visitor>
  void visit(Visitor& v) {
    v("speed", speed, "times real time", 0.01, 1000.0);
    simulation.visit(v);
  }
};

/// A robot in a simulated building, as other services see one: CLOUD, ODOMETRY, TRUTH.
class SimulatorService {
 public:
  /// Builds the world. Throws std::invalid_argument when the rooms do not fit into the building.
  SimulatorService(Bus& bus, Health& health, const SimulatorConfig& config);

  /// Publishes what has happened until now. The run starts with the first call: its times count
  /// from there.
  void tick(std::int64_t now_us);

 private:
  void publish(const SimulatedEvent& event);

  Bus& bus_;
  Health& health_;
  const double speed_;
  SimulatedRun run_;
  std::optional<SimulatedEvent> next_;
  std::optional<std::int64_t> start_us_;
  std::int32_t clouds_ = 0;
};

}  // namespace voxlist
