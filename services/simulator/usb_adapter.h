#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <vector>

namespace voxlist::services {

/// A USB serial adapter between a device and its host: bytes go on 62 together, or when its timer
/// goes round, whatever comes first (FTDI's latency timer).
class UsbAdapter {
 public:
  /// 0 ms: bytes go on at once.
  explicit UsbAdapter(int latency_ms) : latency_us_(latency_ms * std::int64_t{1000}) {}

  /// Takes bytes from the device.
  void take(std::span<const std::uint8_t> bytes);

  /// The bytes that the host gets until a time.
  std::vector<std::uint8_t> given_until(std::int64_t utime_us);

 private:
  const std::int64_t latency_us_;
  std::int64_t round_ = 0;  // of the timer
  std::deque<std::uint8_t> held_;
};

}  // namespace voxlist::services
