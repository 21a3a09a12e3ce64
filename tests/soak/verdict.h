#pragma once

#include <string>
#include <vector>

#include "tests/soak/robot.h"

namespace voxlist::soak {

/// How a service's memory grew after the first hour, in per cent of what it was in the second, for
/// each hour: by the hours' medians. Nothing of less than three hours.
std::optional<double> growth_percent_per_hour(const std::vector<double>& memory_MB_by_minute);

/// What is asked of a run, and whether it was so.
struct Check {
  std::string claim;
  bool is_kept = false;
  std::string seen;
};

/// The checks of a run, from its minutes. Memory is judged in runs of three hours and more.
std::vector<Check> judge(const std::vector<Minute>& minutes);

/// Minutes taken together: the times and counts added, the medians of memory and latencies.
Minute sum(const std::vector<Minute>& minutes, std::size_t from, std::size_t to);

}  // namespace voxlist::soak
