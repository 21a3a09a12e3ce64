#pragma once

#include <vector>

#include "voxlist/scanner/arms/arm_detector.h"

namespace voxlist::scanner {

/// How a mirror is driven and marked.
struct MirrorClockConfig {
  /// One for a single-sided mirror, or two.
  std::vector<BlockingArm> arms;

  /// What is met lower than this above the laser is an arm or the plate's edge: see ArmDetector.
  double arm_height_max_m = 0.075;

  /// Clock edges for one turn of the mirror.
  int steps_per_revolution = 400;

  /// There is a clock: without it the mirror is not as it should be.
  bool has_clock = true;

  /// psi falls as the mirror turns.
  bool turns_backwards = false;

  /// The mirror stands still between the clock's edges; else it turns evenly.
  bool staircase = false;

  /// Sign of the mirror's rate, when it turns as it should.
  double direction() const { return turns_backwards ? -1.0 : 1.0; }
};

}  // namespace voxlist::scanner
