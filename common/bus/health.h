#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "voxlist/bus/channels.h"
#include "voxlist/bus/counters.h"

namespace voxlist::bus {

/// What a service tells of itself once a second on HEALTH.
///
/// How it fares is the sum of conditions, each with a key of its own: one that ends takes nothing
/// of the others with it. Keys are few and fixed; they are not told to anyone.
class Health {
 public:
  /// The values of health_t's STATE_ constants.
  enum class State { kOk = 0, kWarning = 1, kError = 2 };

  explicit Health(std::string service) : service_(std::move(service)) {}

  /// Holds from now on, until it is raised otherwise or cleared. `sentence` is for a person: what,
  /// where, what to do. An empty one clears.
  void raise(const std::string& key, State state, std::string sentence);

  /// The condition has ended; nothing happens when there was none.
  void clear(const std::string& key) { conditions_.erase(key); }

  /// The worst of the conditions' states.
  State state() const;

  /// The conditions' sentences in one line, the worst first, else in the order of their keys. Empty
  /// when there are none.
  std::string message() const;

  /// Counts something of the service's own, e.g. "late_cloud".
  void count(const std::string& what, std::int64_t times = 1) { counters_[what] += times; }

  /// A measure as it is now; its name ends in its unit, e.g. "memory_MB".
  void gauge(const std::string& name, double value) { gauges_[name] = value; }

  /// Notes how long one message took, from its arrival to the end of its handling. A second's first
  /// 10,000 make the percentiles, all make the maximum.
  void add_latency_us(std::int64_t latency_us);

  /// The message to publish, if a second has passed since the last one (or the clock went back);
  /// the latencies start anew then. `more` (a Bus's counters) is listed with its own counters.
  std::optional<health_t> due(std::int64_t now_us, const Counters& more = {});

  /// The same at once: for the last one.
  health_t last(std::int64_t now_us, const Counters& more = {});

 private:
  struct Condition {
    State state;
    std::string sentence;
  };

  void write_latencies(health_t& message);

  std::string service_;
  std::map<std::string, Condition> conditions_;
  Counters counters_;
  std::map<std::string, double> gauges_;
  std::vector<std::int64_t> latencies_us_;
  std::int64_t max_latency_us_ = -1;
  std::optional<std::int64_t> last_us_;
};

}  // namespace voxlist::bus
