#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <stop_token>
#include <string>

#include "voxlist/geometry/laser_line.h"
#include "voxlist/scanner/lms200/lms200_config.h"
#include "voxlist/scanner/lms200/lms200_link.h"
#include "voxlist/scanner/lms200/lms200_scan.h"
#include "voxlist/scanner/lms200/lms200_setup.h"
#include "voxlist/scanner/lms200/scan_clock.h"

namespace voxlist::scanner {

/// What happened since the beginning, and how the device fares.
struct Lms200Report {
  std::int64_t lines = 0;
  std::int64_t lost_scans = 0;                  ///< that the mirror made and that did not come
  std::int64_t damaged = 0;                     ///< telegrams with a wrong CRC, or torn
  std::map<std::string, std::int64_t> refused;  ///< whole scans that made no sense, by reason
  std::int64_t dazzled_beams = 0;
  std::int64_t clock_jumps = 0;
  bool polluted = false;  ///< the front window, in the last scan
  double jitter_us = 0.0;
  double turns_per_second = 0.0;
  std::string type;  ///< "LMS200;301063;V02.10"
};

/// A SICK LMS 200 on a serial line: finds it at whatever speed and in whatever state, sets it up,
/// and receives its scans, each with the time of its first beam. What fails ends the session with
/// an exception: begin() again, for ever if need be. Use it from one thread.
class Lms200 {
 public:
  /// `port` must outlive it. Throws std::invalid_argument when the config is not valid. Nothing is
  /// sent yet.
  Lms200(serial::Port& port, const Lms200Config& config, std::stop_token stop = {});

  /// Starts (or starts anew) the stream of scans. Throws Lms200Failure, PortError.
  void begin();

  /// The next line; nothing when none came for `timeout_us`, at most a second. Refused and damaged
  /// scans are counted and left out. Throws Lms200Failure when no good scan came for a second, or
  /// PortError.
  std::optional<LaserLine> next(std::int64_t timeout_us);

  /// Stops the stream and leaves the device at 9600 baud, as the next one expects it. Takes less
  /// than a second, also when nothing answers.
  void end() noexcept;

  /// Costs a walk over the last 20 s of time stamps.
  Lms200Report report() const;

 private:
  std::optional<LaserLine> take(const Lms200Event& event);
  std::int64_t stamp(const Lms200Event& event, const Lms200Scan& scan);
  int lost_in_stream(std::size_t scan_bytes);
  void refuse(const std::string& reason);
  void check_stream() const;
  void close_clock();
  [[noreturn]] void fail(const std::string& what, bool silent = false) const;

  const Lms200Config config_;
  Lms200Link link_;
  Lms200Setup setup_;
  Lms200ScanFormat format_;
  std::optional<ScanClock> clock_;
  Lms200Report report_;
  std::int64_t silent_us_ = 0;     // since the last good scan
  std::int64_t good_skipped_ = 0;  // bytes that were skipped until then
  int refused_in_row_ = 0;
  int doubt_ = 0;  // of the line: grows with each damaged scan, shrinks with each good one
  std::string last_refusal_;
};

}  // namespace voxlist::scanner
