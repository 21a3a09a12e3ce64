#pragma once

#include <cstdint>

namespace voxlist {

/// Times from here on are no microseconds since the epoch (this is the year 2255) but of another
/// unit: nanoseconds since the epoch are a hundred times as large. The one limit for messages,
/// tables and trajectories. Doubles hold all integers up to it.
inline constexpr std::int64_t kMaxUtime_us = 9'000'000'000'000'000;

}  // namespace voxlist
