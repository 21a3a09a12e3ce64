#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "voxlist/geometry/seconds_between.h"

namespace voxlist::adapter {

/// At most so many a second in the mean, or a few per cent more. What comes a little early is let
/// through as long as others came late: a laser whose period wavers by 10 %, or that turns by 3 %
/// faster than it should, loses nothing to a limit of its own rate.
class RateLimit {
 public:
  explicit RateLimit(double rate_hz) : rate_hz_(rate_hz) {}

  /// Whether one of this time may go; it counts then. A time before the last starts anew.
  bool lets(std::int64_t utime_us) {
    const double since_s = last_us_ ? seconds_between(*last_us_, utime_us) : -1.0;
    saved_ = since_s < 0.0 ? 1.0 : std::min(kMostSaved, saved_ + since_s * rate_hz_ * kMargin);
    last_us_ = utime_us;
    if (saved_ < kOne) return false;
    saved_ -= 1.0;
    return true;
  }

 private:
  // What may be saved up: with less, a laser a little faster than the limit would lose more than it
  // must; with more, two would go at once after a pause.
  static constexpr double kMostSaved = 2.0;
  // What motors turn too fast, with twice that to spare.
  static constexpr double kMargin = 1.05;
  static constexpr double kOne = 1.0 - 1e-9;  // sums of parts are not exact

  double rate_hz_;
  double saved_ = 0.0;
  std::optional<std::int64_t> last_us_;
};

}  // namespace voxlist::adapter
