#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "voxlist/bus/counters.h"

namespace voxlist::service {

/// Turns the counters of lost messages (Bus::losses()) into lines for the log. A reason is told at
/// once when it first occurs, then at most once a second with how many more were lost since.
class DropReport {
 public:
  /// The lines that are due now. To be called again and again with the counters as they grow.
  std::vector<std::string> due(const bus::Counters& losses, std::int64_t now_us);

 private:
  struct Told {
    std::int64_t count = 0;
    std::int64_t time_us = 0;
  };
  std::map<std::string, Told> told_;
};

}  // namespace voxlist::service
