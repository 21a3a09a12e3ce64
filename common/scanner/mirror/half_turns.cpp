#include "voxlist/scanner/mirror/half_turns.h"

#include <cmath>
#include <numbers>

#include "voxlist/geometry/pose.h"

namespace voxlist::scanner {

std::int64_t HalfTurns::count(const MirrorState& state) {
  if (!state.angle_known) {
    turned_rad_.reset();
    return 0;
  }
  if (!turned_rad_) {
    turned_rad_ = first_rad_ = state.angle_rad;
  } else {
    const double expected_rad =
        *turned_rad_ + state.rate_radps * static_cast<double>(state.utime_us - last_us_) * 1e-6;
    turned_rad_ = expected_rad + wrap_angle(state.angle_rad - expected_rad);
  }
  last_us_ = state.utime_us;
  return static_cast<std::int64_t>(std::trunc((*turned_rad_ - first_rad_) / std::numbers::pi));
}

}  // namespace voxlist::scanner
