#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <vector>

namespace voxlist::serial {

/// The device is gone, or cannot be used: what() is one line with the port's path, the system's
/// reason, and what to do.
class PortError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Bytes that arrived together, and when they were taken from the system (wall clock,
/// microseconds).
struct Received {
  std::int64_t utime_us = 0;
  std::vector<std::uint8_t> bytes;
};

/// A serial line, real or simulated. Use it from one thread. All throw PortError when the device is
/// gone.
class Port {
 public:
  virtual ~Port() = default;

  /// What has arrived, waiting for it up to `timeout_us`; nothing when the time is over.
  virtual std::optional<Received> read(std::int64_t timeout_us) = 0;

  virtual void write(std::span<const std::uint8_t> bytes) = 0;

  /// Changes the line's speed and forgets what has arrived. Throws PortError for speeds that the
  /// device does not have.
  virtual void set_baud(int baud) = 0;

  /// Forgets what has arrived and was not yet read.
  virtual void flush() = 0;

  /// The clock of Received::utime_us.
  virtual std::int64_t now_us() const = 0;
};

}  // namespace voxlist::serial
