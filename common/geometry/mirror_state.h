#pragma once

#include <cstdint>
#include <string>

namespace voxlist {

/// Where the scanner's mirror is and how it turns, as mirror_state_t (which has the fields' story).
struct MirrorState {
  enum class State { kSearching = 0, kLocked = 1, kStalled = 2, kFault = 3 };

  std::int64_t utime_us = 0;
  State state = State::kSearching;
  bool angle_known = false;
  std::string reason;
  double angle_rad = 0.0;  ///< [0, 2 pi)
  double rate_radps = 0.0;
  std::int64_t half_revolutions = 0;
  double residual_rad = 0.0;
  double step_rad = 0.0;
};

}  // namespace voxlist
