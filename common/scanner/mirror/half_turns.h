#pragma once

#include <cstdint>
#include <optional>

#include "voxlist/geometry/mirror_state.h"

namespace voxlist::scanner {

/// Counts the mirror's half turns since its angle became known, with their sign.
class HalfTurns {
 public:
  /// Takes the next state; the count, 0 and begun anew where the angle is not known.
  std::int64_t count(const MirrorState& state);

 private:
  std::optional<double> turned_rad_;  // angle of the last state, unwrapped
  double first_rad_ = 0.0;
  std::int64_t last_us_ = 0;
};

}  // namespace voxlist::scanner
