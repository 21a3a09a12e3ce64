#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "voxlist/bus/counters.h"

namespace voxlist::service {

/// Turns a bus's counters into lines for the log: what went wrong the first time at once, then at
/// most once a second with how often since. Messages received, handled, sent or superseded by newer
/// ones are no wrong.
class DropReport {
 public:
  /// The lines that are due now; call it again and again with the counters as they grow.
  std::vector<std::string> due(const bus::Counters& counters, std::int64_t now_us);

 private:
  struct Told {
    std::int64_t count = 0;
    std::int64_t time_us = 0;
  };
  std::map<std::string, Told> told_;
};

}  // namespace voxlist::service
