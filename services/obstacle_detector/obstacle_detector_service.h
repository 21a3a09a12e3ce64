#pragma once

#include <cstdint>
#include <optional>

#include "bus/channels.h"
#include "planning/obstacles.h"

namespace voxlist {

class Bus;
class Health;

/// Looks at the newest CLOUD and publishes OBSTACLES.
class ObstacleDetectorService {
 public:
  /// Throws std::invalid_argument when the config's heights or ranges leave nothing to look at.
  ObstacleDetectorService(Bus& bus, Health& health, const ObstacleConfig& config);

  /// Notes for HEALTH how long the last cloud took.
  void tick(std::int64_t now_us);

 private:
  void take(const pointcloud_t& message);

  Bus& bus_;
  Health& health_;
  const ObstacleConfig config_;
  std::optional<std::int64_t> arrival_us_;  // of the cloud that was handled last
};

}  // namespace voxlist
