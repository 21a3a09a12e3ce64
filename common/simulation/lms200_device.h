#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "scanner/laser_line.h"
#include "scanner/lms200_telegram.h"

namespace voxlist {

/// Faults that a simulated LMS 200 can be given; each lasts until taken back unless it says once.
struct Lms200Faults {
  double drop_byte = 0.0;     ///< probability that a byte of a telegram is lost
  double corrupt_byte = 0.0;  ///< probability that a bit of a byte flips
  double noise_byte = 0.0;    ///< probability that a random byte comes between two others
  bool refuse = false;        ///< answers 15 to every request
  bool silent = false;        ///< answers nothing and sends nothing
  bool address_81 = false;    ///< answers from 81 instead of 80
  bool wrong_unit = false;    ///< scans say the other unit than configured
  bool partial_bits = false;  ///< complete scans carry the bits of partial ones
  bool pollution = false;     ///< front window polluted, in the status
  double dazzle = 0.0;        ///< probability that a beam is dazzled
  double over_max = 0.0;      ///< probability that a beam reports beyond maximum
};

/// What the simulated device measures: the ranges of the half turn that begins at a time, beams 0 to
/// 180 deg in steps of 1 deg, the first at `first_angle_rad`; metres, +infinity beyond maximum.
using MeasureLine = std::function<LaserLine(std::int64_t utime_us, double first_angle_rad)>;

/// A SICK LMS 200 without its case: bytes in, bytes out, each with its time. It answers the whole
/// command set that a driver needs (31, 32, 3A, 3B, 74, 77, 20 with 00 24 25 2A 40 41 42 48, 30 01,
/// 10), turns at its own rate, and sends at the speed of its line. Its clock is what it is told.
class Lms200Device {
 public:
  struct Config {
    double turns_per_second = 75.03;  ///< what its motor really does
    int baud = 9600;                  ///< at power-on
    double power_on_s = 0.5;          ///< until the power-on message; real units take 30 s
    std::uint64_t seed = 1;           ///< of the faults
    bool long_configuration = true;   ///< 34 bytes, else 32 as old firmware
    bool streams_at_start = false;    ///< left streaming at `baud` by a driver that crashed
  };

  Lms200Device(const Config& config, std::int64_t start_utime_us, MeasureLine measure);

  /// A byte of the host, which arrived at a time at the host's speed: at another speed than its own
  /// the device sees garbage.
  void receive(std::int64_t utime_us, int host_baud, std::span<const std::uint8_t> bytes);

  /// A byte that is on the line, and when its stop bit ends.
  struct TimedByte {
    std::int64_t utime_us;
    std::uint8_t byte;
  };

  /// All bytes that have left until now, in order. Times follow from the speed: 10 bits a byte.
  std::vector<TimedByte> sent_until(std::int64_t utime_us);

  /// When the next byte leaves, if that is known: for a simulation that waits.
  std::optional<std::int64_t> next_byte_utime_us() const;

  /// As if switched off and on again.
  void power_cycle(std::int64_t utime_us);

  void set_faults(const Lms200Faults& faults);

  int baud() const;
};

}  // namespace voxlist
