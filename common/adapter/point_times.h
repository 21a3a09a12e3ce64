#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "voxlist/adapter/adapter_config.h"
#include "voxlist/adapter/raw_cloud.h"

namespace voxlist::adapter {

/// When each point of a message was measured.
struct PointTimes {
  /// Seconds from the message's utime, NaN where it is not known; empty: all at utime.
  std::vector<float> offsets_s;

  /// The earliest and the latest of them.
  double first_s = 0.0;
  double last_s = 0.0;

  /// What is wrong with them, for a person; empty when nothing is.
  std::string complaint;

  /// Whether they are of no use.
  bool is_refused = false;
};

/// Longest time from a message's utime to a point of it (s): no laser takes longer for a sweep, so
/// what is farther is in another unit.
inline constexpr double kMaxOffset_s = 5.0;

/// Tells when each point was measured: by the message's own times, or at constant rate.
PointTimes point_times(const RawCloud& raw, const SensorConfig& sensor);

}  // namespace voxlist::adapter
