#include "voxlist/scanner/mirror/mirror_diagnosis.h"

#include <cmath>
#include <cstdio>
#include <numbers>

#include "voxlist/geometry/seconds_between.h"

namespace voxlist::scanner {
namespace {

// For how long a slip is told after it was put right.
constexpr double kTellSlip_s = 5.0;

// Without arms so far, lines that are still for so long speak for a mirror that stands.
constexpr double kNeverTurned_us = 3e6;

template <class... Args>
std::string text(const char* format, Args... args) {
  char line[200];
  std::snprintf(line, sizeof line, format, args...);
  return line;
}

double degrees(double angle_rad) { return angle_rad * 180.0 / std::numbers::pi; }

double turn_s(double rate_radps) { return 2.0 * std::numbers::pi / std::abs(rate_radps); }

}  // namespace

std::string how_it_stands(const MirrorEvidence& evidence) {
  return text("the mirror stands: for %.1f s nothing turns in the lines or no arm came",
              seconds_between(*evidence.stall.since_us(), evidence.now_us));
}

std::string why_searching(const MirrorEvidence& evidence) {
  if (evidence.new_rate) return "the motor's speed has changed: waiting for passages of the arms";
  if (const auto gap_rad = evidence.arms.strange_gap_rad()) {
    return text("arms are %.0f deg apart, which the settings say in neither direction",
                degrees(*gap_rad));
  }
  const std::optional<double> silent_s = evidence.silence.silent_s(evidence.now_us);
  if (!silent_s && evidence.stall.still_us() > kNeverTurned_us)
    return "no arm seen yet, and the lines do not change: the mirror seems to stand";
  if (!silent_s) return "no arm seen yet";
  if (evidence.arms_silent()) return text("no arm seen for %.1f s", *silent_s);
  return "waiting for more passages of the arms";
}

std::string what_is_wrong(const MirrorEvidence& evidence) {
  const MirrorClockConfig& config = evidence.config;
  const std::int64_t now_us = evidence.now_us;
  if (evidence.arms.direction() != config.direction())
    return "reversed: the mirror turns against its settings";
  if (evidence.wrong_rate()) {
    return text(
        "wrong rate: a turn takes %.3f s by the arms, %.3f s by the clock and "
        "steps_per_revolution; going on with the arms",
        turn_s(evidence.arms.rate_radps()), turn_s(evidence.clock.rate_radps()));
  }
  if (config.has_clock && !evidence.clock.running(now_us))
    return "clock lost: going on with the arms";
  if (config.has_clock && !evidence.clock_in_step())
    return "clock not yet in step: going on with the arms";
  if (evidence.slip && seconds_between(evidence.slip->utime_us, now_us) < kTellSlip_s) {
    return text("missed %lld steps of the motor: the arms came %.1f deg late",
                static_cast<long long>(evidence.slip->steps), degrees(evidence.slip->late_rad));
  }
  if (evidence.arms_silent()) {
    return text("no arm seen for %.1f s: going on with the clock",
                *evidence.silence.silent_s(now_us));
  }
  if (const auto arm = evidence.missing_arm()) {
    return text("arm %zu (%.0f deg) not seen for more than two turns: going on without it", *arm,
                degrees(config.arms[*arm].angle_rad));
  }
  return {};
}

}  // namespace voxlist::scanner
