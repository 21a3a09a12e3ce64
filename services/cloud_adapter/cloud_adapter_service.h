#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "voxlist/adapter/cloud_adapter.h"
#include "voxlist/bus/channels.h"
#include "voxlist/bus/wire.h"
#include "voxlist/service/inputs/channel_check.h"

namespace voxlist::bus {
class Bus;
class Health;
}  // namespace voxlist::bus

namespace voxlist::services {

/// The lasers' own channels and ODOMETRY in; CLOUD, and CLOUD_SLICE when asked for, out, from
/// within the handler of the message that completes them.
class CloudAdapterService {
 public:
  /// Throws std::invalid_argument as CloudAdapter does.
  CloudAdapterService(bus::Bus& bus, bus::Health& health, const adapter::AdapterConfig& config);

  /// Throws std::invalid_argument for settings that the constructor would refuse.
  static void check(const adapter::AdapterConfig& config);

  /// Tells HEALTH what is missing, and how long the last cloud took.
  void tick(std::int64_t now_us);

 private:
  void take_cloud(std::size_t sensor, bus::Bytes bytes);
  std::int64_t newly_superseded(std::size_t sensor);
  void take_odometry(const pose_t& message);
  void publish(const adapter::Adapted& adapted);
  void tell(const adapter::Adapted& adapted);
  void tell(std::size_t sensor, const adapter::SensorReport& report);

  bus::Bus& bus_;
  bus::Health& health_;
  const adapter::AdapterConfig config_;
  adapter::CloudAdapter adapter_;
  std::deque<service::ChannelCheck> sensors_;  // in the order of the settings
  service::ChannelCheck odometry_;
  service::ChannelCheck clouds_;          // what is wrong with CLOUD itself
  std::vector<std::int64_t> superseded_;  // of each sensor, before they were read
  std::int32_t clouds_sent_ = 0, slices_sent_ = 0;
  std::int64_t arrival_us_ = 0;  // of the laser's message that came last
  std::optional<std::int64_t> sent_arrival_us_;
};

}  // namespace voxlist::services
