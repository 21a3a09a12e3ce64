#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "voxlist/simulation/random.h"

namespace voxlist::simulation {

/// A byte that is on a serial line, and when its stop bit ends.
struct TimedByte {
  std::int64_t utime_us = 0;
  std::uint8_t byte = 0;
};

/// One direction of a serial line: 8N1, 10 bits a byte, one after the other, perhaps damaged.
class TransmitLine {
 public:
  /// Probabilities, for each byte.
  struct Damage {
    double drop = 0.0;     ///< it is lost
    double corrupt = 0.0;  ///< one of its bits flips
    double noise = 0.0;    ///< a random byte follows it
  };

  explicit TransmitLine(std::uint64_t seed) : random_(seed) {}

  /// Puts bytes on the line at a time, or as soon as it is free.
  void send(std::int64_t utime_us, std::span<const std::uint8_t> bytes, int baud,
            const Damage& damage);

  /// When the last byte has left.
  std::int64_t free_utime_us() const;

  /// Takes the bytes that have left until a time, as a host at that speed hears them: garbage
  /// unless it is the sender's. 0: as they were sent.
  std::vector<TimedByte> take(std::int64_t utime_us, int host_baud);

  /// When the next byte has left.
  std::optional<std::int64_t> next_utime_us() const;

  /// The sender lost its power at a time: what had not left never does.
  void cut(std::int64_t utime_us);

 private:
  struct Sent {
    TimedByte timed;
    int baud;
  };

  void put(std::uint8_t byte, int baud, bool lost);

  Random random_;
  std::deque<Sent> sent_;
  std::int64_t base_utime_us_ = 0;  // free_us_ counts from here: bytes end between microseconds
  double free_us_ = 0.0;
};

/// What a listener at one speed makes of bytes that were sent at another: as many as the time
/// holds.
std::vector<std::uint8_t> garbled(std::size_t bytes, int sender_baud, int listener_baud,
                                  Random& random);

}  // namespace voxlist::simulation
