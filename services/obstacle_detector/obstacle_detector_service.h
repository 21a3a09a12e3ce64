#pragma once

#include <cstdint>
#include <optional>

#include "voxlist/bus/channels.h"
#include "voxlist/planning/obstacles.h"
#include "voxlist/service/inputs/cloud_input.h"

namespace voxlist::bus {
class Bus;
class Health;
}  // namespace voxlist::bus

namespace voxlist::services {

/// Looks at the newest CLOUD and publishes OBSTACLES.
class ObstacleDetectorService {
 public:
  /// Throws std::invalid_argument when the config's heights or ranges leave nothing to look at.
  ObstacleDetectorService(bus::Bus& bus, bus::Health& health,
                          const planning::ObstacleConfig& config);

  /// Throws std::invalid_argument for settings that the constructor would refuse.
  static void check(const planning::ObstacleConfig& config);

  /// Notes for HEALTH how long the last cloud took.
  void tick(std::int64_t now_us);

 private:
  void take(const pointcloud_t& message);

  bus::Bus& bus_;
  bus::Health& health_;
  const planning::ObstacleConfig config_;
  service::CloudInput input_;
  std::optional<std::int64_t> arrival_us_;  // of the cloud that was handled last
};

}  // namespace voxlist::services
