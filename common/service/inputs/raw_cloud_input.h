#pragma once

#include <optional>
#include <string>

#include "voxlist/adapter/adapter_config.h"
#include "voxlist/adapter/raw_cloud.h"
#include "voxlist/bus/cloud_view.h"

namespace voxlist::service {

/// A laser's message as the cloud adapter takes it.
struct RawCloudInput {
  /// Nothing when the message is refused.
  std::optional<adapter::RawCloud> cloud;

  /// Why it is refused, for a person; empty when it is not.
  std::string refusal;
};

/// Takes the points that the thinning leaves, and their times where the settings name a channel.
/// Refuses a message that does not have that channel just once. Cost: that of the points which are
/// taken, whatever the message has.
RawCloudInput take_raw_cloud(const bus::CloudView& message, const adapter::SensorConfig& sensor);

}  // namespace voxlist::service
