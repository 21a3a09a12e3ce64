#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "voxlist/bus/channels.h"
#include "voxlist/scanner/sweep/cloud_assembler.h"
#include "voxlist/service/inputs/channel_check.h"

namespace voxlist::bus {
class Bus;
class Health;
}  // namespace voxlist::bus

namespace voxlist::services {

/// LASER, MIRROR and ODOMETRY in; CLOUD and CLOUD_SLICE out, from within the handler of the message
/// that completes them.
class CloudAssemblerService {
 public:
  /// Throws std::invalid_argument as CloudAssembler does.
  CloudAssemblerService(bus::Bus& bus, bus::Health& health,
                        const scanner::CloudAssemblerConfig& config);

  /// Throws std::invalid_argument for settings that the constructor would refuse.
  static void check(const scanner::CloudAssemblerConfig& config);

  /// Tells HEALTH what is missing, and how long the last cloud took.
  void tick(std::int64_t now_us);

 private:
  // When something last came, to the tick.
  struct Input {
    bool heard = false;
    std::int64_t last_us = 0;
    std::optional<service::ChannelCheck> times = {};
    void note(std::int64_t now_us);
    bool is_silent(std::int64_t now_us) const;
  };

  void take_laser(const planar_lidar_t& message);
  void take_mirror(const mirror_state_t& message);
  void take_odometry(const pose_t& message);
  void publish(const scanner::Assembly& assembly);
  void tell_state(std::int64_t now_us);
  std::string why_no_clouds(std::int64_t now_us) const;
  std::string drop_reason() const;
  bool fits(Input& input, std::int64_t utime_us);

  bus::Bus& bus_;
  bus::Health& health_;
  const scanner::CloudAssemblerConfig config_;
  scanner::CloudAssembler assembler_;
  Input laser_, mirror_, odometry_;
  Input used_;                                  // lines that got as far as a cloud
  std::optional<scanner::LineFate> last_drop_;  // why one did not
  MirrorState mirror_state_;
  double line_share_ = 1.0;  // what share of its lines the last sweep had
  std::int32_t clouds_ = 0, slices_ = 0;
  bool started_ = false;
  std::optional<std::int64_t> arrival_us_;  // of the message that completed the last cloud
};

}  // namespace voxlist::services
