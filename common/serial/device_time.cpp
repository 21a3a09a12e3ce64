#include "voxlist/serial/device_time.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace voxlist::serial {
namespace {

// The line rests on the arrivals of this window (us), of which the earliest in each bucket is kept.
// A longer window averages more jitter and follows a drifting crystal later.
constexpr double kWindow_us = 20e6, kBucket_us = 1e5;

// A line through less time than this (us) says nothing about the clocks' rates.
constexpr double kMinSpan_us = 1e6;

// An arrival that is earlier or later than the line by these (us) is wrong, or a clock was set: so
// many of them in a row mean that it was.
constexpr double kEarly_us = 50'000.0, kLate_us = 1e6;
constexpr int kMaxStrange = 5;

}  // namespace

std::optional<std::int64_t> DeviceTime::wall_us(std::uint32_t device_us, std::int64_t arrival_us) {
  if (!started_) start(device_us, arrival_us);
  const auto passed = static_cast<std::int32_t>(device_us - last_device_);
  const double device = last_us_ + static_cast<double>(passed);
  const double late_us = static_cast<double>(arrival_us - origin_us_) - device;
  const double off_us = late_us - line_us(device);
  if (passed < 0 || off_us < -kEarly_us || off_us > kLate_us) {
    if (++strange_ >= kMaxStrange) started_ = false;
    if (started_) return std::nullopt;
    return wall_us(device_us, arrival_us);
  }
  strange_ = 0;
  last_device_ = device_us;
  last_us_ = device;
  add({device, late_us});
  return origin_us_ + std::llround(device + line_us(device));
}

void DeviceTime::start(std::uint32_t device_us, std::int64_t arrival_us) {
  *this = {};
  started_ = true;
  last_device_ = device_us;
  origin_us_ = arrival_us;
}

void DeviceTime::add(const Arrival& arrival) {
  const auto bucket = [](const Arrival& a) { return std::floor(a.device_us / kBucket_us); };
  if (arrivals_.empty() || bucket(arrivals_.back()) != bucket(arrival)) {
    arrivals_.push_back(arrival);
    while (arrivals_.front().device_us < arrival.device_us - kWindow_us) arrivals_.pop_front();
  } else if (arrival.late_us - line_us(arrival.device_us) <
             arrivals_.back().late_us - line_us(arrivals_.back().device_us)) {
    arrivals_.back() = arrival;
  } else {
    return;
  }
  lay_line();
}

void DeviceTime::lay_line() {
  std::vector<Arrival> hull;
  double middle_us = 0.0;
  for (const Arrival& a : arrivals_) {
    middle_us += a.device_us / static_cast<double>(arrivals_.size());
    while (hull.size() > 1) {
      const Arrival &p = hull[hull.size() - 2], &q = hull.back();
      const double turn = (q.device_us - p.device_us) * (a.late_us - p.late_us) -
                          (q.late_us - p.late_us) * (a.device_us - p.device_us);
      if (turn > 0.0) break;
      hull.pop_back();
    }
    hull.push_back(a);
  }
  const double span_us = arrivals_.back().device_us - arrivals_.front().device_us;
  if (span_us < kMinSpan_us || hull.size() < 2) {
    offset_us_ = std::ranges::min_element(arrivals_, {}, &Arrival::late_us)->late_us;
    return;
  }
  std::size_t right = 1;
  while (right + 1 < hull.size() && hull[right].device_us < middle_us) ++right;
  const Arrival &p = hull[right - 1], &q = hull[right];
  slope_ = (q.late_us - p.late_us) / (q.device_us - p.device_us);
  offset_us_ = p.late_us - slope_ * p.device_us;
}

}  // namespace voxlist::serial
