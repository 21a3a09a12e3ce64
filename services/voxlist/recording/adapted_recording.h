#pragma once

#include <memory>

#include "services/voxlist/recording/recording.h"
#include "voxlist/adapter/adapter_config.h"

namespace voxlist::desk {

/// The channels of the adapter's sensors; none when it has none.
RawChannels channels_of(const adapter::AdapterConfig& config);

/// A recording whose raw records become clouds by the service's own algorithm, as cloud_adapter
/// makes them on a robot. What CLOUD holds behind the first raw record is left out: it is what a
/// robot made of the same. Throws std::invalid_argument for settings that do not fit together.
std::unique_ptr<Recording> adapted(std::unique_ptr<Recording> raw,
                                   const adapter::AdapterConfig& config, Omissions& omissions);

}  // namespace voxlist::desk
