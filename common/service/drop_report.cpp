#include "voxlist/service/drop_report.h"

#include <fmt/core.h>

namespace voxlist::service {
namespace {

// At least so long (us) between two lines about the same reason: HEALTH has the counters once a
// second anyway, and a storm of bad messages must not fill the log.
constexpr std::int64_t kPause_us = 1'000'000;

}  // namespace

std::vector<std::string> DropReport::due(const bus::Counters& losses, std::int64_t now_us) {
  std::vector<std::string> lines;
  for (const auto& [name, count] : losses) {
    Told& told = told_[name];
    const bool first = told.count == 0;
    if (count == told.count || (!first && now_us - told.time_us < kPause_us)) continue;
    lines.push_back(
        fmt::format("{}: {} {}", name, count - told.count,
                    first ? "message(s)" : fmt::format("more message(s), {} in all", count)));
    told = {count, now_us};
  }
  return lines;
}

}  // namespace voxlist::service
