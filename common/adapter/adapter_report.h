#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "voxlist/adapter/sensor_points.h"
#include "voxlist/geometry/cloud.h"

namespace voxlist::adapter {

/// What became of a sensor's message.
enum class MessageFate {
  kUsed,
  kSuperseded,  ///< a newer one came before it could go into a CLOUD
  kOutOfOrder,  ///< no later than the one before
  kBadTimes,    ///< its points' times make no sense
  kNoPoints,    ///< all its points were left out
  kNoOdometry,  ///< ODOMETRY did not come in time
  kOverflow,    ///< too many wait for ODOMETRY
};
inline constexpr std::size_t kMessageFates = 7;

/// What a sensor's messages came to.
struct SensorReport {
  std::array<std::int64_t, kMessageFates> messages{};
  PointCounts points{};

  /// What is wrong with its points' times, for a person; empty when nothing is.
  std::string time_complaint;

  std::int64_t& operator[](MessageFate fate) { return messages[static_cast<std::size_t>(fate)]; }
  std::int64_t operator[](MessageFate fate) const {
    return messages[static_cast<std::size_t>(fate)];
  }
};

/// A message's fate as HEALTH counts it behind the sensor's channel: "no_odometry".
const char* counter_name(MessageFate fate);

/// And a point's: "too_near".
const char* counter_name(PointFate fate);

/// What came of something that was added.
struct Adapted {
  std::vector<Cloud> clouds;
  std::vector<Cloud> slices;

  /// The number of the message that holds the latest point, one number for each of `clouds`.
  std::vector<std::int64_t> numbers;

  /// One for each sensor.
  std::vector<SensorReport> sensors;

  /// CLOUDs that went out without one of the sensors.
  std::int64_t incomplete = 0;
};

}  // namespace voxlist::adapter
