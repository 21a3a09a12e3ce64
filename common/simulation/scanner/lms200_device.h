#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "voxlist/geometry/laser_line.h"
#include "voxlist/scanner/lms200/lms200_scan.h"
#include "voxlist/scanner/lms200/lms200_telegram.h"
#include "voxlist/simulation/random.h"
#include "voxlist/simulation/scanner/transmit_line.h"

namespace voxlist::simulation {

/// Faults that a simulated LMS 200 can be given; each lasts until taken back.
struct Lms200Faults {
  double drop_byte = 0.0;     ///< probability that a byte is lost
  double corrupt_byte = 0.0;  ///< probability that a bit of a byte flips
  double noise_byte = 0.0;    ///< probability that a random byte comes between two others
  bool refuse = false;        ///< answers 15 to every request
  bool silent = false;        ///< answers nothing and sends nothing
  bool address_81 = false;    ///< answers from 81 instead of 80
  bool wrong_unit = false;    ///< scans come in the other unit than configured, and say so
  bool partial_bits = false;  ///< complete scans carry the bits of partial ones
  bool pollution = false;     ///< front window polluted, in the status
  double dazzle = 0.0;        ///< probability that a beam is dazzled
  double over_max = 0.0;      ///< probability that a beam reports beyond maximum
};

/// What the simulated device measures: the ranges of the half turn whose first beam leaves at a
/// time: 181 beams in steps of 1 deg, the first at `first_angle_rad`; metres, +infinity beyond
/// maximum. It is asked when the half turn is over, in the order of times.
using MeasureLine = std::function<LaserLine(std::int64_t utime_us, double first_angle_rad)>;

/// A SICK LMS 200 without its case: bytes in, bytes out, each with its time. It answers the whole
/// command set that a driver needs (31, 32, 3A, 3B, 74, 77, 20 with 00 10 24 25 2A 40 41 42 48,
/// 30 01, 10), turns at its own rate, and sends at the speed of its line. Its clock is what it is
/// told. Precondition: times never go back.
///
/// A scan's telegram begins to leave when its mirror has turned past 180 deg: half a turn after its
/// beam at 0 deg. A scan that is ready while the line is still busy is not sent. In mode 2A each
/// half turn is sent, with angle 180 whatever the variant's: partial scans 0; 0 and 2; or 0 to 3,
/// by the variant's resolution. (What real units do there with angle 100 is documented nowhere.)
class Lms200Device {
 public:
  struct Config {
    double turns_per_second = 75.03;  ///< what its motor really does
    int baud = 9600;                  ///< at power-on
    double power_on_s = 0.5;          ///< until the power-on message; real units take 30 s
    std::uint64_t seed = 1;           ///< of the faults
    bool long_configuration = true;   ///< 34 bytes, else 32 as old firmware
    bool streams_at_start = false;    ///< left streaming at `baud` by a driver that crashed: whole
                                      ///< scans of 180 deg in steps of 1 deg
  };

  /// Switched on at a time: nothing is heard or said until the power-on message.
  Lms200Device(const Config& config, std::int64_t start_utime_us, MeasureLine measure);

  /// Bytes of the host, which arrived at a time at the host's speed: at another speed than its own
  /// the device sees garbage.
  void receive(std::int64_t utime_us, int host_baud, std::span<const std::uint8_t> bytes);

  using TimedByte = simulation::TimedByte;

  /// All bytes that have left until now, in order. Times follow from the speed: 10 bits a byte. A
  /// host that listens at another speed hears garbage; 0: as they were sent.
  std::vector<TimedByte> sent_until(std::int64_t utime_us, int host_baud = 0);

  /// When the next byte leaves, if that is known: for a simulation that waits.
  std::optional<std::int64_t> next_byte_utime_us() const;

  /// As if switched off and on again. The EEPROM keeps what was written; speed, mode and variant
  /// are those of power-on.
  void power_cycle(std::int64_t utime_us);

  void set_faults(const Lms200Faults& faults) { faults_ = faults; }

  int baud() const { return baud_; }

  /// How often its EEPROM was written: it wears out.
  int configuration_writes() const { return configuration_writes_; }

 private:
  using Bytes = std::vector<std::uint8_t>;

  void start_up(std::int64_t utime_us);
  void advance(std::int64_t utime_us);
  std::optional<std::int64_t> next_event_utime_us() const;

  void answer(std::int64_t utime_us, const scanner::Lms200Telegram& request);
  void set_mode(std::int64_t utime_us, const Bytes& data);
  void set_variant(std::int64_t utime_us, const Bytes& data);
  void write_configuration(std::int64_t utime_us, const Bytes& data);
  void one_scan(std::int64_t utime_us);
  Bytes status_report() const;

  scanner::Lms200ScanFormat format() const;
  bool measures() const;
  int interlaced_turns() const { return 100 / resolution_cdeg_; }
  int turns_per_scan() const;
  std::int64_t turn_utime_us(double turn) const;
  std::int64_t scan_ready_utime_us() const;
  void begin_scans(std::int64_t utime_us);
  void send_scan(std::int64_t utime_us);
  scanner::Lms200Scan measured_scan();
  std::vector<scanner::Lms200Value> measured(std::int64_t turn, int quarters) const;
  void inject(std::vector<scanner::Lms200Value>& values);

  std::uint8_t status() const;
  void reply(std::int64_t utime_us, std::uint8_t request, Bytes data);
  void reject(std::int64_t utime_us);
  void send(std::int64_t utime_us, std::uint8_t command, Bytes data);
  void send_byte(std::int64_t utime_us, std::uint8_t byte);
  void put_on_line(std::int64_t utime_us, const Bytes& bytes);

  Config config_;
  std::int64_t start_utime_us_;
  std::int64_t now_utime_us_;
  MeasureLine measure_;
  Random random_;
  Lms200Faults faults_;

  scanner::Lms200Parser parser_;
  TransmitLine line_;
  int baud_ = 0;
  std::optional<std::int64_t> power_on_utime_us_;  // while it starts up

  Bytes eeprom_;
  int configuration_writes_ = 0;
  std::uint8_t mode_ = 0;
  int angle_deg_ = 180;
  int resolution_cdeg_ = 50;
  bool one_scan_ = false;       // was asked for
  std::int64_t next_turn_ = 0;  // of the mirror: the first of the next scan
  std::uint8_t telegram_index_ = 0;
};

}  // namespace voxlist::simulation
