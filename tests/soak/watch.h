#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>
#include <voxlist/health_t.hpp>

namespace voxlist::soak {

/// How a service fared over some time.
struct ServiceTime {
  double memory_MB = 0.0;       ///< the median of what its HEALTH said
  double cpu_s = 0.0;           ///< of all its threads
  double latency_p50_ms = 0.0;  ///< the median of HEALTH's
  double latency_p99_ms = 0.0;  ///< the median of HEALTH's
  int healths = 0;
  int restarts = 0;                          ///< another process spoke in its name
  std::map<std::string, std::int64_t> lost;  ///< messages, by counter (see losses())
  std::map<std::string, int>
      troubles;  ///< how often HEALTH was not OK, by its message with N for numbers
};

/// Follows one service by its HEALTH.
class Watch {
 public:
  void take(const health_t& health);

  /// What was since the last call.
  ServiceTime since_last();

  bool was_heard() const { return pid_ != 0; }

 private:
  std::int32_t pid_ = 0;
  std::map<std::string, std::int64_t> lost_;  // as last told by this process
  double cpu_s_ = 0.0;                        // of this process, at the last call
  ServiceTime now_;
  std::vector<double> memory_MB_, p50_ms_, p99_ms_;
};

/// The counters of a HEALTH that tell of lost messages: dropped, refused, not sent. Those that are
/// meant to be skipped for newer ones are none, nor is what came twice.
std::map<std::string, std::int64_t> losses(const health_t& health);

/// CPU time of a process (s); nullopt when it is gone.
std::optional<double> cpu_of(std::int32_t pid);

}  // namespace voxlist::soak
