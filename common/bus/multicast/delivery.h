#pragma once

namespace voxlist::bus {

/// Which of a channel's messages are to arrive.
enum class Delivery {
  /// Every message, in the order in which they came.
  kEvery,
  /// Only the newest of those that wait: for what is of no use when it is late.
  kLatest,
};

}  // namespace voxlist::bus
