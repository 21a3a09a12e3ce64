#include "services/voxlist/recording/scan_times.h"

#include <fmt/core.h>

#include "voxlist/geometry/time_limit.h"
#include "voxlist/io/files/file.h"

namespace voxlist::desk {
namespace {

// No 3D scanner makes scans faster than this (us): 200 a second. Times in seconds or milliseconds
// seem to be.
constexpr std::int64_t kLeastPeriod_us = 5'000;

// Scans that come less often than this (us) may have times in nanoseconds.
constexpr std::int64_t kLongPeriod_us = 100'000'000;

// Seconds since the epoch have up to 10 digits, milliseconds 13.
constexpr std::int64_t kLargestSeconds = 100'000'000'000;

// Scans after which the period is known.
constexpr std::int64_t kEnough = 3;

}  // namespace

bool ScanTimes::take(std::int64_t number, std::int64_t utime_us) {
  if (utime_us >= kMaxUtime_us) {
    ++too_late_;
    latest_us_ = utime_us;
    leave_out(number, "utime is no microseconds");
    return false;
  }
  if (scans_ > 0 && utime_us <= last_us_) {
    ++(utime_us == last_us_ ? repeated_ : backwards_);
    leave_out(number, utime_us == last_us_ ? "utime repeated" : "utime backwards");
    return false;
  }
  if (scans_++ == 0) first_us_ = utime_us;
  last_us_ = utime_us;
  if (scans_ == kEnough) {
    check_period();
    remark_on_period();
  }
  return true;
}

void ScanTimes::check_at_end() const {
  if (scans_ == 0 && too_late_ > 0) {
    throw io::FileError(path_, fmt::format("utime {} looks like nanoseconds, it must be in "
                                           "microseconds: divide it by 1000",
                                           latest_us_));
  }
  if (scans_ == 1 && repeated_ > 0 && backwards_ == 0) {
    throw io::FileError(path_, fmt::format("every scan has the utime {}, give each the time of its "
                                           "own data in microseconds",
                                           last_us_));
  }
  if (scans_ == 1 && backwards_ > 0) {
    throw io::FileError(path_, "the scans' utimes run backwards, record them in order of time");
  }
  if (scans_ == 2) check_period();
}

void ScanTimes::leave_out(std::int64_t number, const std::string& reason) {
  omissions_.add("CLOUD/" + reason, fmt::format("scan {}: {}", number, reason));
}

void ScanTimes::check_period() const {
  const std::int64_t period_us = (last_us_ - first_us_) / (scans_ - 1);
  if (period_us >= kLeastPeriod_us) return;
  const char* unit = last_us_ < kLargestSeconds ? "seconds" : "milliseconds";
  throw io::FileError(path_, fmt::format("the scans come {} us apart: utime looks like {}, it must "
                                         "be in microseconds",
                                         period_us, unit));
}

void ScanTimes::remark_on_period() const {
  const std::int64_t period_us = (last_us_ - first_us_) / (scans_ - 1);
  if (period_us < kLongPeriod_us) return;
  omissions_.remark(
      fmt::format("the scans come {} s apart: is utime in nanoseconds? It must be in "
                  "microseconds",
                  period_us / 1'000'000));
}

}  // namespace voxlist::desk
