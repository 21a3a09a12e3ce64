#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "voxlist/geometry/laser_line.h"

namespace voxlist::scanner {

/// What is known of the laser and its line before the first scan.
struct ScanClockConfig {
  /// One turn of the laser's mirror, nominal: real motors may be a hundredth off and drift.
  double turn_us = kLaserTurn_us;

  /// Time from a scan's first beam to the arrival of its first byte when nothing held it up.
  double delay_us = 0.0;

  /// Turns of the mirror from one scan to the next: more than one where the line is slower than the
  /// mirror.
  int turns_per_scan = 1;

  /// The line rests on the arrivals of so many seconds.
  double window_s = 20.0;
};

/// When each scan began, from when its first byte arrived. The mirror turns evenly and a byte can
/// arrive late but never early, so the grid is the line under all arrivals: the edge of their lower
/// convex hull that lies under their middle (Moon, Skelly and Towsley 1999). Late arrivals of any
/// kind (an adapter's 16 ms, a stalled process) leave it where it is.
class ScanClock {
 public:
  explicit ScanClock(const ScanClockConfig& config);

  /// Time of the scan's first beam, in the clock of the arrivals, microseconds. `index` counts the
  /// mirror's turns modulo 256, where the device tells it; fewer than that are lost at once.
  /// Without it, scans are taken to follow each other, but for `known_lost` that the stream showed
  /// and did not deliver before this one; one that vanished without a trace is noticed 12 scans
  /// later. Within a millisecond about two seconds after the start.
  std::int64_t first_beam_utime_us(std::int64_t arrival_utime_us, std::optional<std::uint8_t> index,
                                   int known_lost = 0);

  /// The mirror's turn, as estimated.
  double turn_us() const { return line_.turn_us; }

  /// How late scans arrive: the 99th percentile over the window.
  double jitter_us() const;

  /// Scans that the mirror made and that did not come.
  std::int64_t lost_scans() const { return lost_scans_; }

  /// How often the clock of the arrivals was set, or another thing broke the grid, which then
  /// began anew.
  std::int64_t jumps() const { return jumps_; }

 private:
  struct Arrival {
    std::int64_t turn;
    std::int64_t utime_us;
  };

  // The grid: turn `turn` at `utime_us` and its neighbours turn_us apart.
  struct Line {
    std::int64_t turn = 0;
    double utime_us = 0.0;
    double turn_us = 0.0;
    double at_us(std::int64_t n) const {
      return utime_us + static_cast<double>(n - turn) * turn_us;
    }
  };

  std::int64_t next_turn(const Arrival& last, std::optional<std::uint8_t> index,
                         int known_lost) const;
  std::int64_t corrected(const Arrival& last, const Arrival& arrival);
  void note_lateness(double late_us, double gap_us);
  bool is_settled() const;
  bool is_off_grid(double late_us) const;
  void add(const Arrival& arrival);
  void begin_anew();
  double slope_us() const;

  const ScanClockConfig config_;
  std::deque<Arrival> arrivals_;
  std::optional<std::uint8_t> index_;
  Line line_;
  double prior_turn_us_;
  int late_scans_ = 0;  // in a row that did not come near the line
  double least_late_us_ = 0.0;
  std::int64_t lost_scans_ = 0;
  std::int64_t jumps_ = 0;
};

}  // namespace voxlist::scanner
