#include "services/obstacle_detector/obstacles_message.h"

#include <limits>

#include "voxlist/geometry/angle.h"

namespace voxlist::services {

static_assert(static_cast<int>(planning::ObstacleType::kObstacle) == obstacles_t::OBSTACLE);
static_assert(static_cast<int>(planning::ObstacleType::kOverhang) == obstacles_t::OVERHANG);
static_assert(static_cast<int>(planning::ObstacleType::kNegative) == obstacles_t::NEGATIVE);

obstacles_t to_message(const planning::ObstacleScan& scan, const std::string& blind,
                       const planning::ObstacleConfig& config) {
  obstacles_t message{};
  message.utime = scan.utime_us;
  message.blind = blind;
  message.min_height_m = static_cast<float>(config.min_height_m);
  message.max_height_m = static_cast<float>(config.max_height_m);
  message.n_bearings = static_cast<std::int32_t>(scan.ground_seen_to_m.size());
  message.radstep = static_cast<float>(scan.step_rad);
  message.nearest_m.assign(scan.nearest_m.begin(), scan.nearest_m.end());
  message.ground_seen_to_m = scan.ground_seen_to_m;
  message.n_cells = static_cast<std::int32_t>(scan.cells.size());
  for (const planning::ObstacleCell& cell : scan.cells) {
    message.cells.push_back({cell.centre.x(), cell.centre.y()});
    message.types.push_back(static_cast<std::int32_t>(cell.type));
  }
  message.n_moving = static_cast<std::int32_t>(scan.moving.size());
  for (const planning::MovingObstacle& moving : scan.moving)
    message.moving.push_back({{moving.position.x(), moving.position.y()},
                              {moving.velocity_mps.x(), moving.velocity_mps.y()},
                              moving.radius_m});
  return message;
}

planning::ObstacleScan nothing_seen(std::int64_t utime_us, const planning::ObstacleConfig& config) {
  const auto sectors = static_cast<std::size_t>(config.sectors);
  planning::ObstacleScan scan;
  scan.utime_us = utime_us;
  scan.step_rad = kTurn_rad / config.sectors;
  scan.nearest_m.fill(std::vector<float>(sectors, std::numeric_limits<float>::infinity()));
  scan.ground_seen_to_m.assign(sectors, 0.0F);
  return scan;
}

}  // namespace voxlist::services
