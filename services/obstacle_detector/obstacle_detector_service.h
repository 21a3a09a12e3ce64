#pragma once

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

 private:
  void take(const pointcloud_t& message);

  Bus& bus_;
  Health& health_;
  const ObstacleConfig config_;
};

}  // namespace voxlist
