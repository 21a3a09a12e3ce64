#include "voxlist/evaluation/association.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <numeric>

namespace voxlist::evaluation {
namespace {

using Order = std::vector<std::size_t>;
constexpr std::int64_t kSecondUs = 1'000'000;
constexpr std::int64_t kYearUs = 365 * 86'400 * kSecondUs;

Order by_time(const io::PoseTable& truth) {
  Order order(truth.rows.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return truth.rows[a].utime_us < truth.rows[b].utime_us;
  });
  return order;
}

std::int64_t tolerance_us(const io::PoseTable& truth, const Order& order) {
  std::vector<std::int64_t> intervals;
  for (std::size_t i = 1; i < order.size(); ++i) {
    intervals.push_back(truth.rows[order[i]].utime_us - truth.rows[order[i - 1]].utime_us);
  }
  if (intervals.empty()) {
    return kSecondUs / 2;
  }
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::nth_element(intervals.begin(), middle, intervals.end());
  return *middle / 2;
}

PosePairs match_times(const std::vector<StampedPose3>& estimate, const io::PoseTable& truth) {
  const Order order = by_time(truth);
  const std::int64_t tolerance = tolerance_us(truth, order);
  std::multimap<std::int64_t, std::size_t> free;
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    free.emplace(estimate[i].utime_us, i);
  }
  PosePairs result{Association::kByTime, {}};
  for (const std::size_t row : order) {
    const std::int64_t utime = truth.rows[row].utime_us;
    auto nearest = free.lower_bound(utime);
    if (nearest != free.begin() &&
        (nearest == free.end() || utime - std::prev(nearest)->first <= nearest->first - utime)) {
      --nearest;
    }
    if (nearest != free.end() && std::abs(nearest->first - utime) <= tolerance) {
      result.pairs.emplace_back(row, nearest->second);
      free.erase(nearest);
    }
  }
  return result;
}

std::vector<std::int64_t> scan_numbers(const std::vector<StampedPose3>& estimate) {
  const bool numbered = std::all_of(estimate.begin(), estimate.end(), [](const StampedPose3& p) {
    return p.utime_us % kSecondUs == 0 && p.utime_us >= 0 && p.utime_us < kYearUs;
  });
  std::vector<std::int64_t> numbers;
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    numbers.push_back(numbered ? estimate[i].utime_us / kSecondUs : static_cast<std::int64_t>(i));
  }
  return numbers;
}

PosePairs match_scans(const std::vector<StampedPose3>& estimate, const io::PoseTable& truth) {
  std::map<std::int64_t, std::size_t> free;
  const std::vector<std::int64_t> numbers = scan_numbers(estimate);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    free.emplace(numbers[i], i);
  }
  PosePairs result{Association::kByScanNumber, {}};
  for (const std::size_t row : by_time(truth)) {
    if (const auto found = free.find(truth.rows[row].scan); found != free.end()) {
      result.pairs.emplace_back(row, found->second);
      free.erase(found);
    }
  }
  return result;
}

}  // namespace

PosePairs associate(const std::vector<StampedPose3>& estimate, const io::PoseTable& truth) {
  const PosePairs timed = match_times(estimate, truth);
  return timed.pairs.empty() ? match_scans(estimate, truth) : timed;
}

}  // namespace voxlist::evaluation
