#pragma once

#include <cstdint>
#include <optional>

#include "voxlist/bus/channels.h"
#include "voxlist/planning/obstacles/blindness.h"
#include "voxlist/planning/obstacles/obstacle_finder.h"
#include "voxlist/service/inputs/cloud_input.h"

namespace voxlist::bus {
class Bus;
class Health;
}  // namespace voxlist::bus

namespace voxlist::services {

/// CLOUD_SLICE (where there is none, CLOUD) and ODOMETRY in; OBSTACLES out, with each of them, and
/// as often while it is blind.
class ObstacleDetectorService {
 public:
  /// Throws std::invalid_argument when the config's heights or ranges leave nothing to look at.
  ObstacleDetectorService(bus::Bus& bus, bus::Health& health,
                          const planning::ObstacleConfig& config);

  /// Throws std::invalid_argument for settings that the constructor would refuse.
  static void check(const planning::ObstacleConfig& config);

  /// Tells that it is blind, and notes for HEALTH how long the last cloud took.
  void tick(std::int64_t now_us);

 private:
  using Part = planning::ObstacleFinder::Part;

  void take_slice(const pointcloud_t& message);
  void take_cloud(const pointcloud_t& message);
  void take_odometry(const pose_t& message);
  void take_mirror(const mirror_state_t& message);
  void look(const Cloud& cloud, Part part);
  void publish(const planning::ObstacleScan& scan, const std::string& blind);
  std::int64_t utime_at(std::int64_t now_us) const;

  bus::Bus& bus_;
  bus::Health& health_;
  const planning::ObstacleConfig config_;
  planning::ObstacleFinder finder_;
  planning::Blindness blindness_;
  service::CloudInput clouds_;
  service::ChannelCheck slices_, odometry_;
  std::optional<std::int64_t> arrival_us_;  // of the cloud that was handled last, for its latency
  struct Taken {
    std::int64_t utime_us;
    std::int64_t came_us;
  };
  std::optional<Taken> last_;
  // Times of ticks: the last one, and those at which the last slice came and OBSTACLES went out.
  std::int64_t now_us_ = 0;
  std::optional<std::int64_t> slice_us_, published_us_;
};

}  // namespace voxlist::services
