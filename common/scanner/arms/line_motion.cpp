#include "voxlist/scanner/arms/line_motion.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace voxlist::scanner {
namespace {

// A range has changed when it did by more than this (m) and this share: more than a robot's own
// motion makes of it in 30 to 800 ms.
constexpr float kChange_m = 0.06F, kRelativeChange = 0.07F;

// A robot that turns while the mirror stands shifts what the beams meet by up to so many beams of 1
// deg.
constexpr std::size_t kTurned_beams = 3;

// Two lines with fewer beams to compare say nothing.
constexpr int kMinReturns = 20;

// The mirror turns when more than this share of the beams changed: people who walk by change fewer.
constexpr double kMovingShare = 0.25;

// Lines that are kept to compare with: a second of them, more than the longest lag.
constexpr std::size_t kMaxLines = 80;

// Stillness between the last so many passages is normal: four turns of two arms. With fewer than
// three passages nothing is known.
constexpr std::size_t kPassages = 8, kMinPassages = 3;

// Stillness is more than normal when it is longer by this factor and this time (us). In seven hours
// of driving through three buildings a mirror that turned needed 89'000 us; more would tell a stall
// later.
constexpr double kFactor = 1.3, kMargin_us = 100'000.0;

// Time without lines is no stillness. A line speaks for the time since the one before it, but for
// no longer than two lines take (us); in a hole longer than kMaxGap_us nobody saw what happened.
constexpr double kLineSpeaks_us = 30'000.0;
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

std::optional<double> compare(const LaserLine& now, const LaserLine& before) {
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
  if (returns < kMinReturns) return std::nullopt;
  return static_cast<double>(changed) / returns;
}

// How much a line's time counts as stillness: nearly whole for a robot that turns on the spot under
// a mirror that stands, and little where a mirror that turns changes nearly enough.
double stillness(double changed_share) {
  const double part = changed_share / kMovingShare;
  return 1.0 - part * part * part;
}

}  // namespace

std::optional<double> LineMotion::add(const LaserLine& line, double lag_us) {
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
  const auto changed = best == nullptr ? std::nullopt : compare(line, *best);
  lines_.push_back(line);
  if (lines_.size() > kMaxLines) lines_.pop_front();
  return changed;
}

void StallWatch::add(std::optional<double> changed, std::int64_t utime_us) {
  const std::int64_t gap_us = utime_us - last_us_.value_or(utime_us);
  last_us_ = utime_us;
  if (gap_us > kMaxGap_us) {
    still_us_ = since_moving_us_ = 0.0;
    hole_since_passage_ = true;
  }
  const double spoken_for_us = std::clamp(static_cast<double>(gap_us), 0.0, kLineSpeaks_us);
  since_moving_us_ += spoken_for_us;
  const bool moves = changed && *changed > kMovingShare;
  moving_lines_ = moves ? moving_lines_ + 1 : 0;
  if (moves)
    still_us_ = since_moving_us_ = 0.0;
  else if (changed)
    still_us_ += spoken_for_us * stillness(*changed);
  longest_still_.since_passage_us = std::max(longest_still_.since_passage_us, still_us_);
  longest_unmoved_.since_passage_us = std::max(longest_unmoved_.since_passage_us, since_moving_us_);
}

void StallWatch::turned() {
  // A hole has cut short what would have been normal.
  if (std::exchange(hole_since_passage_, false)) return;
  longest_still_.passed(still_us_);
  longest_unmoved_.passed(since_moving_us_);
}

bool StallWatch::knows_normal() const { return longest_still_.earlier_us.size() >= kMinPassages; }

bool StallWatch::stalled() const {
  return knows_normal() && still_us_ > kFactor * longest_still_.normal_us() + kMargin_us;
}

bool StallWatch::moving() const {
  const double normal_us = knows_normal() ? longest_unmoved_.normal_us() : 0.0;
  return since_moving_us_ < std::max(kRestless_us, normal_us + kMargin_us);
}

void StallWatch::Longest::passed(double now_us) {
  earlier_us.push_back(since_passage_us);
  if (earlier_us.size() > kPassages) earlier_us.pop_front();
  since_passage_us = now_us;
}

double StallWatch::Longest::normal_us() const { return *std::ranges::max_element(earlier_us); }

}  // namespace voxlist::scanner
