#include "services/obstacle_detector/obstacle_detector_service.h"

#include <limits>
#include <stdexcept>
#include <voxlist/obstacles_t.hpp>
#include <voxlist/pointcloud_t.hpp>

#include "voxlist/bus/bus.h"
#include "voxlist/bus/health.h"

namespace voxlist::services {
namespace {

// A detector that can see nothing would tell a planner that the way is free.
const planning::ObstacleConfig& checked(const planning::ObstacleConfig& config) {
  if (config.min_height_m >= config.max_height_m)
    throw std::invalid_argument("min_height_m must be below max_height_m");
  if (config.min_range_m >= config.max_range_m)
    throw std::invalid_argument("min_range_m must be below max_range_m");
  return config;
}

obstacles_t to_message(const planning::ObstacleScan& scan, const planning::ObstacleConfig& config) {
  obstacles_t message{};
  message.utime = scan.utime_us;
  message.min_height_m = static_cast<float>(config.min_height_m);
  message.max_height_m = static_cast<float>(config.max_height_m);
  message.n_bearings = static_cast<std::int32_t>(scan.ranges_m.size());
  message.rad0 = 0.0F;
  message.radstep = static_cast<float>(scan.step_rad);
  const std::vector<float> none(scan.ranges_m.size(), std::numeric_limits<float>::infinity());
  message.nearest_m.assign(3, none);
  message.nearest_m[obstacles_t::OBSTACLE] = scan.ranges_m;
  message.ground_seen_to_m.assign(scan.ranges_m.size(), 0.0F);
  message.n_cells = static_cast<std::int32_t>(scan.cells_m.size());
  for (const Eigen::Vector2f& cell : scan.cells_m) message.cells.push_back({cell.x(), cell.y()});
  message.types.assign(scan.cells_m.size(), obstacles_t::OBSTACLE);
  return message;
}

}  // namespace

ObstacleDetectorService::ObstacleDetectorService(bus::Bus& bus, bus::Health& health,
                                                 const planning::ObstacleConfig& config)
    : bus_(bus),
      health_(health),
      config_(checked(config)),
      input_(health, service::CloudInput::Sees::kTheNewest) {
  bus_.subscribe(
      bus::kCloud, [this](const pointcloud_t& m) { take(m); }, bus::Delivery::kLatest);
}

void ObstacleDetectorService::check(const planning::ObstacleConfig& config) { checked(config); }

void ObstacleDetectorService::take(const pointcloud_t& message) {
  const std::optional<Cloud> cloud = input_.take(message);
  if (!cloud) return;
  bus_.publish(bus::kObstacles, to_message(planning::nearest_obstacles(*cloud, config_), config_));
  arrival_us_ = bus_.arrival_utime_us();
}

void ObstacleDetectorService::tick(std::int64_t now_us) {
  input_.tick(now_us);
  if (arrival_us_) health_.add_latency_us(now_us - *arrival_us_);
  arrival_us_.reset();
}

}  // namespace voxlist::services
