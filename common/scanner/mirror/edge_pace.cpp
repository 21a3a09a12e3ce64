#include "voxlist/scanner/mirror/edge_pace.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

namespace voxlist::scanner {
namespace {

// Edges that are looked at together: a new speed is told within about so many.
constexpr std::size_t kEdges = 24;

// The edges belong to another clock when they are late, or early, by so many periods together: 3 %
// over all of them. Jitter counts only at both ends, and jitter of a tenth of a period stays far
// below.
constexpr double kMaxLate = 0.72;

// The typical edge has to be late by so many periods as well. One edge far off, or a device's time
// that is brought to the wall clock anew, does not change the typical one.
constexpr double kMinTypicalLate = 0.025;

// An edge that is off its place by more than this share of a period is strange. When half of the
// edges are, it is the clock that has changed.
constexpr double kStrange = 0.3;

bool is_strange(double late) { return std::abs(late) > kStrange; }

double median(const std::deque<double>& values) {
  std::vector<double> sorted(values.begin(), values.end());
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return *middle;
}

}  // namespace

bool EdgePace::changed(double since_us, double period_us) {
  const auto late_after = [&](const std::optional<double>& edge_us) {
    const double periods = (since_us - edge_us.value_or(since_us)) / period_us;
    return periods - std::round(periods);
  };
  // Past a strange edge against the last good one: jitter is then summed up at both ends only.
  // Against the strange one where that fits better: time was shifted.
  const double late_good = late_after(last_good_us_);
  const double late = is_strange(late_good) ? late_after(last_us_) : late_good;
  last_us_ = since_us;
  if (!is_strange(late)) last_good_us_ = since_us;
  late_.push_back(late);
  if (late_.size() > kEdges) late_.pop_front();
  if (late_.size() < kEdges) return false;
  if (2 * std::ranges::count_if(late_, is_strange) >= std::ssize(late_)) return true;
  double all_late = 0.0;
  for (const double edge_late : late_) all_late += is_strange(edge_late) ? 0.0 : edge_late;
  if (std::abs(all_late) < kMaxLate) return false;
  return std::copysign(1.0, all_late) * median(late_) > kMinTypicalLate;
}

}  // namespace voxlist::scanner
