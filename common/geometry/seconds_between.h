#pragma once

#include <cstdint>

namespace voxlist {

/// Seconds from one time in microseconds to another; negative when the other is earlier.
inline double seconds_between(std::int64_t from_us, std::int64_t to_us) {
  return static_cast<double>(to_us - from_us) * 1e-6;
}

}  // namespace voxlist
