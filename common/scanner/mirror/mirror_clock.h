#pragma once

#include <cstdint>
#include <memory>

#include "voxlist/geometry/laser_line.h"
#include "voxlist/geometry/mirror_state.h"
#include "voxlist/scanner/mirror/mirror_clock_config.h"
#include "voxlist/scanner/mirror/mirror_trouble.h"

namespace voxlist::scanner {

/// Tells where the mirror is, from its motor's clock, from its arms in the laser's lines, or from
/// what there is of both. A pure estimator: time comes with the data.
///
/// The clock gives the rate, the arms of the last 64 turns the phase (passage_fit.h). The arms
/// alone are always followed too, so that they take over when the clock is lost, and tell when its
/// rate or direction is wrong. Time that jumps back, or by more than 2 s, starts everything anew;
/// so does a clock that was in step and changes its period: the motor was given another speed.
class MirrorClock {
 public:
  struct Counts {
    std::int64_t edges = 0;
    std::int64_t lost_edges = 0;   ///< put in
    std::int64_t extra_edges = 0;  ///< doubled, or in a strange place: left out
    std::int64_t clock_restarts = 0;
    std::int64_t arm_events = 0;
    std::int64_t strange_arm_events = 0;  ///< not where they were expected
    std::int64_t missed_steps = 0;        ///< of the motor: how far the mirror slipped
    std::int64_t stalls = 0;
    std::int64_t time_jumps = 0;
  };

  explicit MirrorClock(const MirrorClockConfig& config);
  MirrorClock(MirrorClock&&) noexcept;
  ~MirrorClock();

  /// Takes an edge of the clock. Edges may come somewhat later than lines of the same time.
  void add_edge(std::int64_t utime_us);

  /// Takes a line and says where the mirror is then: `utime_us` is the line's, or the last edge's
  /// before it. Costs some 20 us, and about 0.5 ms when an arm has passed.
  MirrorState add_line(const LaserLine& line);

  /// What was wrong with the mirror at the last line.
  MirrorTrouble trouble() const;

  Counts counts() const;

  /// The clock's measured period, microseconds; 0 when it is not known.
  double clock_period_us() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace voxlist::scanner
