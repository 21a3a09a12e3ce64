#pragma once

#include <map>
#include <string>
#include <vector>

#include "voxlist/bus/channels.h"

namespace voxlist::desk {

/// How the services fare, by what each last said on HEALTH. Times are seconds of any clock that
/// never goes back.
class HealthBoard {
 public:
  /// Services that must be there: those that never speak are shown, too.
  explicit HealthBoard(std::vector<std::string> expected = {});

  void take(const health_t& message, double now_s);

  /// Whether each expected service was heard; with none expected, whether any was.
  bool all_heard() const;

  /// Whether no service is in error or silent, and all expected ones are there.
  bool is_well(double now_s) const;

  /// A table: service, state, 99th percentile of its latency, memory, age of what it said, why,
  /// and what else it measures. SILENT is a service that says nothing any more, or never did.
  std::vector<std::string> table(double now_s) const;

  /// "mapper: ERROR: the disk is full", for each service with something to say.
  std::vector<std::string> troubles(double now_s) const;

 private:
  struct Entry {
    bool heard = false;
    double heard_s = 0.0;
    std::int32_t state = 0;
    float latency_p99_ms = -1.0F;
    std::string message;
    std::map<std::string, double> gauges = {};
  };

  static std::string state_of(const Entry& entry, double now_s);
  static std::string reason_of(const Entry& entry, double now_s);

  std::map<std::string, Entry> entries_;
};

}  // namespace voxlist::desk
