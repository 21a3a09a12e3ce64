#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "voxlist/scanner/lms200/lms200.h"
#include "voxlist/serial/port.h"
#include "voxlist/simulation/random.h"
#include "voxlist/simulation/scanner/lms200_device.h"

namespace voxlist::scanner {

/// A line between a host and a simulated device, in virtual time: only waiting makes it pass.
class VirtualPort : public serial::Port {
 public:
  VirtualPort(simulation::Lms200Device& device, std::int64_t now_us, double jitter_us = 1000.0)
      : device_(device), now_us_(now_us), jitter_us_(jitter_us) {}

  std::optional<serial::Received> read(std::int64_t timeout_us) override {
    const std::int64_t end_us = now_us_ + timeout_us;
    const auto next_us = device_.next_byte_utime_us();
    if (next_us && *next_us > now_us_ && *next_us <= end_us)
      now_us_ =
          std::min(end_us, *next_us + static_cast<std::int64_t>(random_.uniform(0.0, jitter_us_)));
    serial::Received received;
    for (const simulation::TimedByte& byte : device_.sent_until(now_us_, baud_))
      received.bytes.push_back(byte.byte);
    if (received.bytes.empty()) {
      now_us_ = end_us;
      return std::nullopt;
    }
    received.utime_us = now_us();
    return received;
  }

  void write(std::span<const std::uint8_t> bytes) override {
    if (device_gone) throw serial::PortError("/dev/virtual: the device is gone; plug it in");
    device_.receive(now_us_, baud_, bytes);
  }
  void set_baud(int baud) override {
    flush();
    baud_ = baud;
  }
  void flush() override { device_.sent_until(now_us_, baud_); }
  std::int64_t now_us() const override { return now_us_ + clock_set_us; }

  /// The host does something else.
  void sleep(std::int64_t duration_us) { now_us_ += duration_us; }

  bool device_gone = false;
  std::int64_t clock_set_us = 0;  ///< by how much somebody set the host's clock

 private:
  simulation::Lms200Device& device_;
  std::int64_t now_us_;
  const double jitter_us_;
  int baud_ = 9600;
  simulation::Random random_{7};
};

/// A world in which no two half turns look alike; it remembers what was measured of late.
class Lms200World {
 public:
  LaserLine measure(std::int64_t utime_us, double first_angle_rad) {
    LaserLine line;
    line.utime_us = utime_us;
    line.first_angle_rad = first_angle_rad;
    for (int beam = 0; beam < 181; ++beam) {
      const auto mm = random_.bits() % 8100;
      line.ranges_m.push_back(static_cast<float>(static_cast<double>(mm) * 1e-3));
    }
    measured_.push_back(line);
    if (measured_.size() > 300) measured_.pop_front();
    return line;
  }

  /// The half turn that a line shows: every range that it gives is the one that was measured.
  const LaserLine* shown_by(const LaserLine& line) const {
    const auto same = [&](const LaserLine& truth) {
      for (std::size_t i = 0; i < line.ranges_m.size(); ++i) {
        const float range_m = line.ranges_m[i];
        if (std::isfinite(range_m) && range_m != truth.ranges_m[i]) return false;
      }
      return true;
    };
    const auto found = std::find_if(measured_.rbegin(), measured_.rend(), same);
    return found == measured_.rend() ? nullptr : &*found;
  }

 private:
  std::deque<LaserLine> measured_;
  simulation::Random random_{3};
};

}  // namespace voxlist::scanner
