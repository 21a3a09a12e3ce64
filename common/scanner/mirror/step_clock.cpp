#include "voxlist/scanner/mirror/step_clock.h"

#include <algorithm>
#include <cmath>

#include "voxlist/system/check.h"

namespace voxlist::scanner {
namespace {

// A hole longer than this (us), or an edge that is older than the one before by more than that,
// starts the clock anew: the device was away, or its time was set.
constexpr std::int64_t kMaxGap_us = 2'000'000, kOutOfOrder_us = 100'000;

// The period is first taken from so many edges: the median of 16 gaps bears seven lost or doubled
// ones.
constexpr std::size_t kFirstEdges = 17;

// The fit remembers about so many edges, 2.5 s at 5 ms: jitter of 0.2 ms averages to 0.02 ms, while
// the wall clock's slow corrections are followed.
constexpr double kMemory_edges = 500.0;

// An edge that is off its place by more than this share of a period is not this clock's. At 0.5
// nothing would be off.
constexpr double kMaxOff = 0.42;

// It is another clock when, of about the last kBadnessMemory edges, so many did not follow the one
// before by a period. A text stream that loses four of ten edges stays far below that.
constexpr double kBadnessMemory = 24.0, kMaxBadness = 18.0;

// The clock is lost when no edge came for so long (us), and for so many periods: a text stream on
// USB comes in pieces of 16 ms, and loses a few edges in a row.
constexpr double kLostAfter_us = 250'000.0, kLostAfterPeriods = 8.0;

// After so many edges the period is known well enough to hold the next ones against it.
constexpr double kKnownEdges = 200.0;

// The median of the first gaps counts as a fit over so many edges.
constexpr double kMedianEdges = 4.0;

}  // namespace

void StepClock::reset() {
  const Counts counts = counts_;
  *this = {};
  counts_ = counts;
  ++counts_.restarts;
}

void StepClock::add_edge(std::int64_t utime_us) {
  ++counts_.edges;
  if (origin_us_) {
    const double gap_us = static_cast<double>(utime_us - *origin_us_) - last_raw_us_;
    if (gap_us > kMaxGap_us || gap_us < -kOutOfOrder_us) reset();
  }
  if (!origin_us_) origin_us_ = utime_us;
  last_raw_us_ = static_cast<double>(utime_us - *origin_us_);
  if (ready()) return follow(last_raw_us_);
  first_us_.push_back(last_raw_us_);
  if (first_us_.size() == kFirstEdges) learn();
}

void StepClock::learn() {
  std::vector<double> gaps_us;
  for (std::size_t i = 1; i < first_us_.size(); ++i)
    gaps_us.push_back(first_us_[i] - first_us_[i - 1]);
  const auto middle = gaps_us.begin() + static_cast<std::ptrdiff_t>(gaps_us.size() / 2);
  std::nth_element(gaps_us.begin(), middle, gaps_us.end());
  const std::vector<double> edges_us = std::move(first_us_);
  first_us_.clear();
  if (*middle <= 0.0) return;
  period_us_ = *middle;
  fitted_us_ = edges_us.front();
  fitted_edges_ = kMedianEdges;
  for (std::size_t i = 1; i < edges_us.size() && ready(); ++i) follow(edges_us[i]);
}

bool StepClock::fits_no_longer(double since_us) {
  if (badness_ > kMaxBadness) return true;
  return fitted_edges_ >= kKnownEdges && pace_.changed(since_us, period_us_);
}

void StepClock::follow(double since_us) {
  const double periods = (since_us - fitted_us_) / period_us_;
  const auto steps = std::llround(periods);
  const bool strange = std::abs(periods - static_cast<double>(steps)) > kMaxOff;
  const double bad = strange || steps != 1 ? 1.0 : 0.0;
  badness_ += bad - badness_ / kBadnessMemory;
  if (fits_no_longer(since_us)) {
    ++counts_.rate_changes;
    return reset();
  }
  if (strange) {
    ++counts_.strange;
  } else if (steps <= 0) {
    ++counts_.doubled;
  } else {
    counts_.lost += steps - 1;
    step_ += steps;
    // Least squares over all edges so far, then over about the last kMemory_edges (alpha-beta
    // filter with the gains of an expanding line fit).
    const double n = fitted_edges_ = std::min(fitted_edges_ + 1.0, kMemory_edges);
    const double expected_us = fitted_us_ + static_cast<double>(steps) * period_us_;
    const double error_us = since_us - expected_us;
    fitted_us_ = expected_us + 2.0 * (2.0 * n - 1.0) / (n * (n + 1.0)) * error_us;
    period_us_ += 6.0 / (n * (n + 1.0)) * error_us / static_cast<double>(steps);
  }
}

bool StepClock::running(std::int64_t utime_us) const {
  if (!ready()) return false;
  const double since_us = static_cast<double>(utime_us - *origin_us_) - last_raw_us_;
  return std::abs(since_us) < std::max(kLostAfter_us, kLostAfterPeriods * period_us_);
}

double StepClock::steps_at(std::int64_t utime_us) const {
  VOXLIST_CHECK(ready(), "steps are asked for before the period is known");
  const double since_us = static_cast<double>(utime_us - *origin_us_) - fitted_us_;
  return static_cast<double>(step_) + since_us / period_us_;
}

std::int64_t StepClock::edge_us(std::int64_t step) const {
  VOXLIST_CHECK(ready(), "an edge is asked for before the period is known");
  return *origin_us_ + std::llround(fitted_us_ + static_cast<double>(step - step_) * period_us_);
}

}  // namespace voxlist::scanner
