#include "voxlist/service/inputs/time_gate.h"

#include <algorithm>

#include "voxlist/geometry/time_limit.h"

namespace voxlist::service {
namespace {

// Messages that must agree before a new time is believed: two may be a message and its copy.
constexpr int kWitnesses = 3;

}  // namespace

bool TimeGate::follows(std::int64_t before_us, std::int64_t utime_us) const {
  const std::int64_t step_us = utime_us - before_us;
  return step_us > -disorder_us_ && step_us <= kMaxStep_us && step_us != 0;
}

TimeGate::Verdict TimeGate::judge(std::int64_t utime_us) {
  if (utime_us < 0 || utime_us >= kMaxUtime_us) return Verdict::kNotMicroseconds;
  if (!newest_us_ || follows(*newest_us_, utime_us)) {
    newest_us_ = std::max(newest_us_.value_or(utime_us), utime_us);
    other_us_.reset();
    return Verdict::kFits;
  }
  if (utime_us == *newest_us_) return Verdict::kRepeated;
  others_ = other_us_ && follows(*other_us_, utime_us) ? others_ + 1 : 1;
  other_us_ = utime_us;
  if (others_ < kWitnesses) return utime_us < *newest_us_ ? Verdict::kBackwards : Verdict::kAhead;
  newest_us_ = utime_us;
  other_us_.reset();
  return Verdict::kFits;
}

}  // namespace voxlist::service
