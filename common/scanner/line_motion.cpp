#include "scanner/line_motion.h"

#include <algorithm>
#include <cmath>

namespace voxlist {
namespace {

// Nearer returns are the robot's own body and the mirror.
constexpr float kFar_m = 0.5F;

// A range has changed when it did by more than what driving and turning make of it.
constexpr float kChange_m = 0.06F, kRelativeChange = 0.05F;

constexpr int kMinReturns = 20;
constexpr double kMovingShare = 0.3;

constexpr std::size_t kMaxLines = 80;

// Passages that are remembered: of two arms, four turns.
constexpr std::size_t kPassages = 8, kMinPassages = 3;

// Longer than normal, for certain.
constexpr double kFactor = 1.3, kMargin_us = 80'000.0;

// Time without lines is no stillness.
constexpr std::int64_t kMaxGap_us = 100'000;

LineMotion::Seen compare(const LaserLine& a, const LaserLine& b) {
  int returns = 0, changed = 0;
  for (std::size_t i = 0; i < a.ranges_m.size(); ++i) {
    const float x = a.ranges_m[i], y = b.ranges_m[i];
    if (!(x > kFar_m) || !(y > kFar_m) || (std::isinf(x) && std::isinf(y))) continue;
    ++returns;
    const float near = std::min(x, y);
    changed += std::abs(x - y) > kChange_m + kRelativeChange * near;
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
