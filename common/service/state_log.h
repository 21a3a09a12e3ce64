#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "voxlist/bus/health.h"

namespace voxlist::service {

/// Turns changes of how a service fares into lines for its log.
///
/// A change is another state, or a sentence with other words; numbers in it (seconds, shares)
/// change all the time and are no news. Each is told at once, but a state that flickers must not
/// fill the log: after ten lines one more a second.
class StateLog {
 public:
  struct Line {
    bus::Health::State state;
    std::string text;
  };

  /// The line that is due now. To be called again and again with the state as it is.
  std::optional<Line> due(bus::Health::State state, const std::string& message,
                          std::int64_t now_us);

 private:
  bool may_tell(std::int64_t now_us);

  bus::Health::State told_state_ = bus::Health::State::kOk;
  std::string told_words_;
  // Lines that may still be told, and since when they are counted.
  std::int64_t lines_left_ = kBurst;
  std::optional<std::int64_t> since_us_;

  static constexpr std::int64_t kBurst = 10;
};

}  // namespace voxlist::service
