#pragma once

#include <cstdint>
#include <optional>

#include "services/simulator/live_scanner.h"
#include "services/simulator/simulator_config.h"
#include "voxlist/simulation/run/simulated_run.h"

namespace voxlist::bus {
class Bus;
class Health;
}  // namespace voxlist::bus

namespace voxlist::services {

/// A robot in a simulated building, as other services see one: ODOMETRY, TRUTH, and a scanner on
/// its ports or CLOUD.
class SimulatorService {
 public:
  /// Builds the world. Throws std::invalid_argument when the rooms do not fit into the building, or
  /// settings do not fit together.
  SimulatorService(bus::Bus& bus, bus::Health& health, const SimulatorConfig& config);

  /// Throws std::invalid_argument for settings that the constructor would refuse.
  static void check(const SimulatorConfig& config);

  /// Publishes what has happened until now. The run starts with the first call, which makes the
  /// scanner's ports (throws PortError): its times count from there.
  void tick(std::int64_t now_us);

  /// Can be read when the next event is due.
  int wake_fd() const { return timer_.get(); }

 private:
  void start(std::int64_t now_us);
  void wait_for_next(std::int64_t now_us) const;
  void publish(const simulation::SimulatedEvent& event);

  bus::Bus& bus_;
  bus::Health& health_;
  const SimulatorConfig config_;
  simulation::SimulatedRun run_;
  FileDescriptor timer_;
  std::optional<simulation::SimulatedEvent> next_;
  std::optional<std::int64_t> start_us_;
  std::optional<LiveScanner> scanner_;
  std::int32_t clouds_ = 0;
};

}  // namespace voxlist::services
