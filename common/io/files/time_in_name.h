#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace voxlist::io {

/// Units in which file names tell times since 1970.
enum class TimeUnit { kSeconds, kMilliseconds, kMicroseconds, kNanoseconds };

const char* name(TimeUnit unit);

struct TimeInName {
  std::int64_t utime_us = 0;
  TimeUnit unit = TimeUnit::kSeconds;
};

/// The time in a scan's name, as recorders give them: 1403636579763555584.pcd (also in seconds,
/// milliseconds or microseconds: only one unit gives a year between 2001 and 2096),
/// scan_1700000001.25.ply, 1700000001_250000000.ply (seconds, then six or nine digits of the
/// second), 12.50.ply (seconds from any start). Nothing when it has none.
std::optional<TimeInName> time_in_name(const std::filesystem::path& file);

}  // namespace voxlist::io
