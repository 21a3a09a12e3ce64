#pragma once

#include <cstdint>
#include <deque>
#include <optional>

namespace voxlist::serial {

/// Brings the times of a device's own clock to the wall clock. What it sends arrives late by any
/// amount, but never early: so the device's clock is a straight line under all arrivals of the last
/// 20 s, the edge of their lower convex hull below their middle (Moon, Skelly and Towsley 1999).
/// The least delay stays in the result, as a constant.
class DeviceTime {
 public:
  /// Wall clock time, microseconds, of a device's time (microseconds modulo 2^32) that arrived at
  /// `arrival_us`. Nothing for times that do not fit the ones before, until five in a row do not:
  /// then one of the clocks was set, and all starts anew.
  std::optional<std::int64_t> wall_us(std::uint32_t device_us, std::int64_t arrival_us);

 private:
  struct Arrival {
    double device_us;
    double late_us;  // arrival minus device's time, since the first
  };

  void start(std::uint32_t device_us, std::int64_t arrival_us);
  void add(const Arrival& arrival);
  void lay_line();
  double line_us(double device_us) const { return offset_us_ + slope_ * device_us; }

  bool started_ = false;
  std::uint32_t last_device_ = 0;
  double last_us_ = 0.0;
  std::int64_t origin_us_ = 0;
  std::deque<Arrival> arrivals_;  // the earliest of each tenth of a second
  double offset_us_ = 0.0, slope_ = 0.0;
  int strange_ = 0;
};

}  // namespace voxlist::serial
