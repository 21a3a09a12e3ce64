#pragma once

#include <vector>

#include "voxlist/geometry/mirror_state.h"

namespace voxlist::calibration {

/// MIRROR's states, corrected by what later states knew better.
struct SteadyMirror {
  std::vector<MirrorState> states;

  /// How far what it said at the time was off, RMS over the later half of each stretch: how well
  /// the phases of this log are those of other days.
  double wander_rad = 0.0;
};

/// While a clock turns the mirror evenly its angle is a line, which MIRROR knows the better the
/// more passages of the arms it has seen: each stretch of LOCKED states at one speed gets the line
/// of its last state. The last second before the stretch breaks off may already be wrong, and is
/// left out, as are states that are not LOCKED. Without a clock states stay as they are.
SteadyMirror steadied(const std::vector<MirrorState>& states);

}  // namespace voxlist::calibration
