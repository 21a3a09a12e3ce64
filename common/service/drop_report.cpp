#include "voxlist/service/drop_report.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace voxlist::service {
namespace {

constexpr std::int64_t kPauseUs = 1'000'000;

bool is_wrong(std::string_view counter) {
  static constexpr std::array<std::string_view, 4> kFine = {"received", "handled", "sent",
                                                            "superseded"};
  return std::ranges::count(kFine, counter.substr(counter.rfind('/') + 1)) == 0;
}

}  // namespace

std::vector<std::string> DropReport::due(const bus::Counters& counters, std::int64_t now_us) {
  std::vector<std::string> lines;
  for (const auto& [name, count] : counters) {
    if (!is_wrong(name)) continue;
    Told& told = told_[name];
    const bool first = told.count == 0;
    if (count == told.count || (!first && now_us - told.time_us < kPauseUs)) continue;
    lines.push_back(
        name + ": " + std::to_string(count - told.count) +
        (first ? " message(s)" : " more message(s), " + std::to_string(count) + " in all"));
    told = {count, now_us};
  }
  return lines;
}

}  // namespace voxlist::service
