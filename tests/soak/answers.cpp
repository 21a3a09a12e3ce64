#include "tests/soak/answers.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace voxlist::soak {
namespace {

// Clouds are answered within this (us).
constexpr std::int64_t kKept_us = 30'000'000;

}  // namespace

void Answers::add(const Answers& more) {
  tracking += more.tracking;
  ambiguous += more.ambiguous;
  lost += more.lost;
  wrong += more.wrong;
  unanswered += more.unanswered;
  answer_ms.insert(answer_ms.end(), more.answer_ms.begin(), more.answer_ms.end());
  error_mm.insert(error_mm.end(), more.error_mm.begin(), more.error_mm.end());
}

void RecentTruth::add(std::int64_t utime_us, const Pose2& T_map_base) {
  poses_[utime_us] = T_map_base;
  poses_.erase(poses_.begin(), poses_.lower_bound(utime_us - kKept_us));
}

Pose2 RecentTruth::at(std::int64_t utime_us) const {
  const auto after = poses_.lower_bound(utime_us);
  if (after == poses_.end()) return poses_.rbegin()->second;
  if (after == poses_.begin()) return after->second;
  const auto before = std::prev(after);
  const double share = static_cast<double>(utime_us - before->first) /
                       static_cast<double>(after->first - before->first);
  return before->second * part_of(before->second.inverse() * after->second, share);
}

double percentile(std::vector<double> values, double percent) {
  if (values.empty()) return 0.0;
  std::ranges::sort(values);
  const double rank = std::ceil(percent / 100.0 * static_cast<double>(values.size()));
  return values[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
}

}  // namespace voxlist::soak
