#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "voxlist/bus/channels.h"
#include "voxlist/bus/counters.h"

namespace voxlist::bus {

/// What a service tells of itself once a second on HEALTH.
class Health {
 public:
  /// The values of health_t's STATE_ constants.
  enum class State { kOk = 0, kWarning = 1, kError = 2 };

  explicit Health(std::string service) : service_(std::move(service)) {}

  /// How it fares from now on; `message` is one line for a person, empty when all is well.
  void set_state(State state, std::string message = {});

  /// Counts something of the service's own, e.g. "late_cloud".
  void count(const std::string& what, std::int64_t times = 1) { counters_[what] += times; }

  /// Notes how long one message took, from its arrival to the end of its handling. A second's first
  /// 10,000 make the percentiles, all make the maximum.
  void add_latency_us(std::int64_t latency_us);

  /// The message to publish, if a second has passed since the last one (or the clock went back);
  /// the latencies start anew then. `more` (a Bus's counters) is listed with its own counters.
  std::optional<health_t> due(std::int64_t now_us, const Counters& more = {});

 private:
  std::string service_;
  State state_ = State::kOk;
  std::string message_;
  Counters counters_;
  std::vector<std::int64_t> latencies_us_;
  std::int64_t max_latency_us_ = -1;
  std::optional<std::int64_t> last_us_;
};

}  // namespace voxlist::bus
