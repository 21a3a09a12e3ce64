#include "scanner/line_motion.h"

#include <algorithm>
#include <cmath>

namespace voxlist {
namespace {

// A range has changed when it did by more than what driving and turning make of it.
constexpr float kChange_m = 0.06F, kRelativeChange = 0.07F;

// A robot that turns while the mirror stands moves what the beams meet by so many beams.
constexpr std::size_t kTurned_beams = 3;

constexpr int kMinReturns = 20;
constexpr double kMovingShare = 0.25;

constexpr std::size_t kMaxLines = 80;

// Passages that are remembered: of two arms, four turns.
constexpr std::size_t kPassages = 8, kMinPassages = 3;

// Longer than normal, for certain.
constexpr double kFactor = 1.3, kMargin_us = 80'000.0;

// Time without lines is no stillness.
constexpr std::int64_t kMaxGap_us = 100'000;

// The nearest and the farthest of what a beam and its neighbours within kTurned_beams met; NaN when
// the beam measured nothing.
struct Envelope {
  float near_m, far_m;
};

Envelope envelope(const std::vector<float>& ranges_m, std::size_t beam) {
  const std::size_t first = beam < kTurned_beams ? 0 : beam - kTurned_beams;
  const std::size_t last = std::min(beam + kTurned_beams, ranges_m.size() - 1);
  Envelope result{ranges_m[beam], ranges_m[beam]};
  for (std::size_t i = first; i <= last; ++i) {
    if (ranges_m[i] < result.near_m) result.near_m = ranges_m[i];
    if (ranges_m[i] > result.far_m) result.far_m = ranges_m[i];
  }
  return result;
}

LineMotion::Seen compare(const LaserLine& now, const LaserLine& before) {
  int returns = 0, changed = 0;
  for (std::size_t i = 0; i < now.ranges_m.size(); ++i) {
    const float range_m = now.ranges_m[i];
    const Envelope was = envelope(before.ranges_m, i);
    const bool tells = std::isfinite(range_m) ? !std::isnan(was.near_m) : std::isfinite(was.far_m);
    if (!tells || std::isnan(range_m)) continue;
    ++returns;
    const float slack_m = kChange_m + kRelativeChange * std::min(range_m, was.near_m);
    changed += range_m < was.near_m - slack_m || range_m > was.far_m + slack_m;
  }
  if (returns < kMinReturns) return LineMotion::Seen::kNothing;
  return changed > kMovingShare * returns ? LineMotion::Seen::kMoving : LineMotion::Seen::kStill;
}

}  // namespace

LineMotion::Seen LineMotion::add(const LaserLine& line, double lag_us) {
  const LaserLine* best = nullptr;
  double best_off_us = 0.3 * lag_us;
  for (const LaserLine& earlier : lines_) {
    const bool same_beams = earlier.ranges_m.size() == line.ranges_m.size() &&
                            earlier.first_angle_rad == line.first_angle_rad;
    const auto lag = static_cast<double>(line.utime_us - earlier.utime_us);
    if (!same_beams || std::abs(lag - lag_us) > best_off_us) continue;
    best = &earlier;
    best_off_us = std::abs(lag - lag_us);
  }
  const Seen seen = best == nullptr ? Seen::kNothing : compare(line, *best);
  lines_.push_back(line);
  if (lines_.size() > kMaxLines) lines_.pop_front();
  return seen;
}

void StallWatch::add(LineMotion::Seen seen, std::int64_t utime_us) {
  const std::int64_t gap_us = utime_us - last_us_.value_or(utime_us);
  last_us_ = utime_us;
  since_moving_us_ += static_cast<double>(std::max<std::int64_t>(gap_us, 0));
  moving_lines_ = seen == LineMotion::Seen::kMoving ? moving_lines_ + 1 : 0;
  if (moving_lines_ > 0) still_us_ = since_moving_us_ = 0.0;
  if (seen == LineMotion::Seen::kStill && gap_us > 0 && gap_us < kMaxGap_us)
    still_us_ += static_cast<double>(gap_us);
  longest_us_ = std::max(longest_us_, still_us_);
}

void StallWatch::turned() {
  normal_us_.push_back(longest_us_);
  if (normal_us_.size() > kPassages) normal_us_.pop_front();
  longest_us_ = still_us_;
}

bool StallWatch::stalled() const {
  if (normal_us_.size() < kMinPassages) return false;
  return still_us_ > kFactor * *std::ranges::max_element(normal_us_) + kMargin_us;
}

}  // namespace voxlist
