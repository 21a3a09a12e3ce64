#pragma once

#include <string>
#include <voxlist/obstacles_t.hpp>

#include "voxlist/planning/obstacles/obstacle_config.h"
#include "voxlist/planning/obstacles/obstacle_scan.h"

namespace voxlist::services {

/// OBSTACLES of a scan. `blind`: why it sees nothing; empty where it does.
obstacles_t to_message(const planning::ObstacleScan& scan, const std::string& blind,
                       const planning::ObstacleConfig& config);

/// A scan of what nobody looked at: nothing in the way, and no floor.
planning::ObstacleScan nothing_seen(std::int64_t utime_us, const planning::ObstacleConfig& config);

}  // namespace voxlist::services
