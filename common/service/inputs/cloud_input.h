#pragma once

#include <optional>

#include "voxlist/bus/channels.h"
#include "voxlist/geometry/cloud.h"
#include "voxlist/service/inputs/channel_check.h"

namespace voxlist::service {

/// CLOUD's door: turns messages into clouds, refuses and counts those of no use, and tells HEALTH
/// what is wrong with them.
class CloudInput {
 public:
  enum class Sees {
    kEveryMessage,
    /// Some are skipped on purpose (Delivery::kLatest): gaps in their numbers mean nothing.
    kTheNewest,
  };

  explicit CloudInput(bus::Health& health, Sees sees = Sees::kEveryMessage);

  /// The cloud, unless it is refused.
  std::optional<Cloud> take(const pointcloud_t& message);

  /// See ChannelCheck.
  void leave_out(std::int64_t messages) { check_.leave_out(messages); }
  void tick(std::int64_t now_us) { check_.tick(now_us); }

 private:
  bus::Health& health_;
  const Sees sees_;
  ChannelCheck check_;
};

}  // namespace voxlist::service
