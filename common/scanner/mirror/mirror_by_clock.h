#pragma once

#include <cstdint>
#include <optional>

#include "voxlist/scanner/arms/arm_detector.h"
#include "voxlist/scanner/mirror/mirror_clock_config.h"
#include "voxlist/scanner/mirror/mirror_track.h"
#include "voxlist/scanner/mirror/step_clock.h"

namespace voxlist::scanner {

/// Tells where the mirror is from its motor's clock: the clock's steps give the rate, the passages
/// of the arms the phase.
class MirrorByClock {
 public:
  /// How a passage fits the ones before it.
  struct Verdict {
    std::optional<bool> fits;        ///< where it was expected; nothing when it was not
    std::optional<double> slip_rad;  ///< how far the mirror slipped, which was put right
  };

  /// An edge of the clock, and the mirror's angle then (of any turn).
  struct Stop {
    std::int64_t utime_us;
    double angle_rad;
  };

  explicit MirrorByClock(const MirrorClockConfig& config);

  /// Takes an edge of the clock.
  void add_edge(std::int64_t utime_us) { clock_.add_edge(utime_us); }

  /// Forgets the passages; times of the next ones are near `origin_us`. Goes on counting.
  void start(std::int64_t origin_us);

  /// Forgets the clock's edges.
  void reset_clock() { clock_.reset(); }

  /// Looks whether the clock's count became known or started anew: then no earlier passage holds.
  void notice_restart();

  /// Whether passages fitted the clock and, since the last call, its edges came to have another
  /// period: the motor turns at another speed. To be asked before notice_restart().
  bool changed_rate();

  /// The sign of the mirror's rate, as it was seen; when it changes no earlier passage holds.
  void set_direction(double direction);

  /// Takes the next passage of an arm.
  Verdict add(const ArmPassage& passage);

  /// The mirror may have slipped by any angle.
  void doubt();

  /// Whether the clock's rate is known.
  bool ready() const { return clock_.ready(); }

  /// Whether it is known and edges came lately.
  bool running(std::int64_t utime_us) const { return clock_.running(utime_us); }

  /// Whether passages fit the clock. Only then may stop_before() and residual_rad() be asked for.
  bool locked() const { return track_ && track_->locked(); }

  /// Whether enough passages did for the phase to be as well known as it will be.
  bool grown() const;

  /// The last edge before a time.
  Stop stop_before(std::int64_t utime_us) const;

  /// Standard deviation of the angle.
  double residual_rad() const;

  /// The mirror's rate, negative when psi falls; only when ready().
  double rate_radps() const;

  double step_rad() const { return step_rad_; }
  double period_us() const { return clock_.period_us(); }
  const StepClock::Counts& counts() const { return clock_.counts(); }

 private:
  PassageAngles::Span span(const TimeSpan& time) const;

  MirrorClockConfig config_;
  double step_rad_;
  double direction_;
  StepClock clock_;
  std::optional<MirrorTrack> track_;
  std::int64_t generation_ = 0;    // the clock's count that the track belongs to
  std::int64_t rate_changes_ = 0;  // those that were noticed
  std::int64_t origin_us_ = 0;
};

}  // namespace voxlist::scanner
