#include "voxlist/scanner/lms200/scan_clock.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

namespace voxlist::scanner {
namespace {

// Fewer arrivals than these, or over less time (us), say too little to call anything wrong.
constexpr double kSettled_us = 2e6;
constexpr std::size_t kSettledScans = 100;

// Standard deviation of a motor's period, as a share of it, once it was known: what a motor drifts.
constexpr double kPeriodSd = 0.0004;

// The mean lateness (us) with which arrivals are weighed against that knowledge: a USB adapter's 16
// ms. Smaller, and the slope follows an adapter's beat; larger, and it follows the motor later.
constexpr double kMeanLate_us = 16'000.0;

// No arrival is on time to the microsecond, so the line lies too high at its end: by so many mean
// latenesses, divided by the number of arrivals.
constexpr double kBias = 3.0;

// An arrival that is earlier than the line by more than this (us) is not on its grid: more than the
// line's own error.
constexpr double kEarly_us = 5000.0;

// One scan in a few comes this near to the line (us); when none of so many does, the line is wrong.
// An adapter that delays evenly by up to 16 ms keeps 150 scans away with one chance in 10^13.
constexpr double kLate_us = 5000.0;
constexpr int kLateScans = 150;

// Without an index, so many scans in a row that are late by a whole turn mean that one was lost.
// More than kSlipTurns turns are no lost scans; kSlipError_us (us) is what the least late one may
// be off by.
constexpr int kSlipScans = 12;
constexpr double kSlipTurns = 4.0;
constexpr double kSlipError_us = 2000.0;

// Scans that are later than this (us), so many in a row, mean that the clock was set: no need to
// wait for kLateScans.
constexpr double kFar_us = 150'000.0;
constexpr int kFarScans = 15;

struct Point {
  double x, y;
};

bool turns_left(const Point& a, const Point& b, const Point& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) > 0.0;
}

std::vector<Point> lower_hull(const std::vector<Point>& points) {
  std::vector<Point> hull;
  for (const Point& point : points) {
    while (hull.size() > 1 && !turns_left(hull[hull.size() - 2], hull.back(), point))
      hull.pop_back();
    hull.push_back(point);
  }
  return hull;
}

// Slope of the line under all points that is likeliest when they are late by kMeanLate_us in the
// mean, exponentially, and the slope is prior +- sd. It rests on a corner of the hull, or on one of
// its edges: the more points, the more surely on the edge under their middle.
double slope_under(const std::vector<Point>& points, double prior, double sd) {
  const std::vector<Point> hull = lower_hull(points);
  double sum = 0.0;
  for (const Point& point : points) sum += point.x;
  const auto edge = [&](std::size_t i) {
    return (hull[i + 1].y - hull[i].y) / (hull[i + 1].x - hull[i].x);
  };
  for (std::size_t i = 0;; ++i) {
    const double lever = sum - static_cast<double>(points.size()) * hull[i].x;
    const double wanted = prior + sd * sd * lever / kMeanLate_us;
    if (i + 1 == hull.size() || wanted <= edge(i))
      return i == 0 ? wanted : std::max(wanted, edge(i - 1));
  }
}

}  // namespace

ScanClock::ScanClock(const ScanClockConfig& config)
    : config_(config), line_{0, 0.0, config.turn_us}, prior_turn_us_(config.turn_us) {}

std::int64_t ScanClock::first_beam_utime_us(std::int64_t utime_us,
                                            std::optional<std::uint8_t> index, int known_lost) {
  if (!arrivals_.empty()) {
    const std::int64_t gap_us = utime_us - arrivals_.back().utime_us;
    if (gap_us < 0 || static_cast<double>(gap_us) > config_.window_s * 1e6) begin_anew();
  }
  Arrival arrival{0, utime_us};
  if (!arrivals_.empty()) {
    const Arrival last = arrivals_.back();
    arrival.turn = next_turn(last, index, known_lost);
    if (!index) arrival.turn = corrected(last, arrival);
    const double late_us = static_cast<double>(utime_us) - line_.at_us(arrival.turn);
    note_lateness(late_us, static_cast<double>(utime_us - last.utime_us));
    if (is_off_grid(late_us)) {
      begin_anew();
    } else {
      const double scans = static_cast<double>(arrival.turn - last.turn) / config_.turns_per_scan;
      lost_scans_ += std::max<std::int64_t>(std::llround(scans) - 1, 0);
    }
  }
  index_ = index;
  add(arrival);
  return std::llround(line_.at_us(arrival.turn) - config_.delay_us);
}

// An index that stands still is none. It is good for 3.4 s, and no line is silent for so long; what
// comes later by the clock was held up.
std::int64_t ScanClock::next_turn(const Arrival& last, std::optional<std::uint8_t> index,
                                  int known_lost) const {
  if (index && index_ && *index != *index_)
    return last.turn + static_cast<std::uint8_t>(*index - *index_);
  return last.turn + config_.turns_per_scan * (1 + known_lost);
}

// Without an index: fewer were lost than thought when a scan comes before its time, more when many
// in a row come a whole turn late.
std::int64_t ScanClock::corrected(const Arrival& last, const Arrival& arrival) {
  const double late_us = static_cast<double>(arrival.utime_us) - line_.at_us(arrival.turn);
  if (is_settled() && late_us < -kEarly_us) {
    const auto early = static_cast<std::int64_t>(std::ceil(-late_us / line_.turn_us));
    return std::max(arrival.turn - early, last.turn + 1);
  }
  const double slip = std::floor((least_late_us_ + kSlipError_us) / line_.turn_us);
  if (late_scans_ < kSlipScans || slip < 1.0 || slip > kSlipTurns) return arrival.turn;
  late_scans_ = 0;
  return arrival.turn + std::llround(slip);
}

// Scans that were held up together come at once and tell nothing, except on the line.
void ScanClock::note_lateness(double late_us, double gap_us) {
  if (!is_settled() || late_us <= kLate_us) {
    late_scans_ = 0;
  } else if (gap_us > 0.5 * line_.turn_us) {
    least_late_us_ = late_scans_ == 0 ? late_us : std::min(least_late_us_, late_us);
    ++late_scans_;
  }
}

bool ScanClock::is_off_grid(double late_us) const {
  const bool before_its_time = is_settled() && late_us < -kEarly_us;
  const bool far = late_scans_ >= kFarScans && least_late_us_ > kFar_us;
  return before_its_time || far || late_scans_ >= kLateScans;
}

bool ScanClock::is_settled() const {
  const auto span_us = arrivals_.back().utime_us - arrivals_.front().utime_us;
  return arrivals_.size() >= kSettledScans && static_cast<double>(span_us) > kSettled_us;
}

void ScanClock::begin_anew() {
  if (is_settled()) prior_turn_us_ = line_.turn_us;
  arrivals_.clear();
  line_ = {0, 0.0, prior_turn_us_};
  late_scans_ = 0;
  ++jumps_;
}

void ScanClock::add(const Arrival& arrival) {
  arrivals_.push_back(arrival);
  const auto oldest_us = arrival.utime_us - std::llround(config_.window_s * 1e6);
  while (arrivals_.front().utime_us < oldest_us) arrivals_.pop_front();

  const double slope_us = this->slope_us();
  line_ = {arrival.turn, static_cast<double>(arrival.utime_us), slope_us};
  double sum_us = 0.0;  // of all arrivals, brought to this turn
  for (const Arrival& a : arrivals_) {
    const double moved_us = static_cast<double>(a.utime_us - arrival.utime_us) +
                            slope_us * static_cast<double>(arrival.turn - a.turn);
    sum_us += moved_us;
    line_.utime_us = std::min(line_.utime_us, static_cast<double>(arrival.utime_us) + moved_us);
  }
  const auto scans = static_cast<double>(arrivals_.size());
  const double mean_late_us =
      sum_us / scans - (line_.utime_us - static_cast<double>(arrival.utime_us));
  line_.utime_us -= mean_late_us * kBias / (scans + kBias);
}

double ScanClock::slope_us() const {
  const Arrival& first = arrivals_.front();
  std::vector<Point> points;
  points.reserve(arrivals_.size());
  for (const Arrival& a : arrivals_) {
    points.push_back({static_cast<double>(a.turn - first.turn),
                      static_cast<double>(a.utime_us - first.utime_us)});
  }
  return slope_under(points, prior_turn_us_, kPeriodSd * prior_turn_us_);
}

double ScanClock::jitter_us() const {
  if (arrivals_.empty()) return 0.0;
  std::vector<double> late_us;
  late_us.reserve(arrivals_.size());
  for (const Arrival& a : arrivals_)
    late_us.push_back(static_cast<double>(a.utime_us) - line_.at_us(a.turn));
  const auto p99 = late_us.begin() + static_cast<std::ptrdiff_t>(late_us.size() * 99 / 100);
  std::nth_element(late_us.begin(), p99, late_us.end());
  return *p99;
}

}  // namespace voxlist::scanner
