#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "voxlist/scanner/arms/arm_silence.h"
#include "voxlist/scanner/mirror/mirror_by_arms.h"
#include "voxlist/scanner/mirror/mirror_by_clock.h"
#include "voxlist/scanner/mirror/mirror_clock_config.h"
#include "voxlist/scanner/mirror/mirror_stall.h"

namespace voxlist::scanner {

/// All that is known of the mirror at one moment, and what its parts say together.
struct MirrorEvidence {
  /// The motor missed steps, as the arms told.
  struct Slip {
    std::int64_t utime_us;
    std::int64_t steps;
    double late_rad;
  };

  explicit MirrorEvidence(const MirrorClockConfig& config);

  /// Forgets all but the clock's count and the direction.
  void start(std::int64_t utime_us);

  /// The mirror's rate, by its arms or else by its clock; nothing when neither knows.
  std::optional<double> rate_radps() const;

  /// The arms turn at another rate than the clock that is running.
  bool wrong_rate() const;

  /// The clock is running and tells where the mirror is.
  bool clock_in_step() const;

  /// See ArmSilence; false and none when the rate is not known.
  bool arms_silent() const;
  bool arms_silent_in_view() const;
  std::optional<std::size_t> missing_arm() const;

  MirrorClockConfig config;
  MirrorByClock clock;
  MirrorByArms arms;
  ArmSilence silence;
  MirrorStall stall;
  std::optional<Slip> slip;  ///< the last one
  bool new_rate = false;     ///< the motor's speed has changed, and no arm has confirmed it yet
  std::int64_t now_us = 0;   ///< of the last line
};

}  // namespace voxlist::scanner
