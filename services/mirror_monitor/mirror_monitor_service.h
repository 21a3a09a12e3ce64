#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "services/mirror_monitor/mirror_monitor_config.h"
#include "voxlist/bus/channels.h"
#include "voxlist/scanner/mirror/mirror_clock.h"
#include "voxlist/serial/edge_source.h"

namespace voxlist {
struct MirrorState;
}

namespace voxlist::bus {
class Bus;
class Health;
}  // namespace voxlist::bus

namespace voxlist::services {

/// Reads the mirror's clock and LASER, and publishes MIRROR for each line.
class MirrorMonitorService {
 public:
  /// Tells when text from a clock arrives, microseconds.
  using WallClock = std::function<std::int64_t()>;

  /// Throws std::invalid_argument for settings that make no sense. The clock's device may come
  /// later, and go.
  MirrorMonitorService(bus::Bus& bus, bus::Health& health, const MirrorMonitorConfig& config);
  MirrorMonitorService(bus::Bus& bus, bus::Health& health, const MirrorMonitorConfig& config,
                       WallClock wall_clock);

  /// Throws std::invalid_argument for settings that the constructor would refuse.
  static void check(const MirrorMonitorConfig& config);

  /// Can be read when the clock has edges.
  int wake_fd() const { return edges_ ? edges_->wake_fd() : -1; }

  /// Takes the clock's edges, and tells HEALTH how the mirror fares.
  void tick(std::int64_t now_us);

 private:
  void take(const planar_lidar_t& message);
  void read_edges();
  void count();
  void tell();

  bus::Bus& bus_;
  bus::Health& health_;
  scanner::MirrorClock clock_;
  std::unique_ptr<serial::EdgeSource> edges_;
  std::optional<MirrorState> last_;
  std::int64_t now_us_ = 0;
  std::optional<std::int64_t> arrival_us_;
  std::map<std::string, std::int64_t> counted_;
};

}  // namespace voxlist::services
