#include "voxlist/scanner/mirror/mirror_diagnosis.h"

#include <fmt/core.h>

#include <cmath>
#include <numbers>

#include "voxlist/geometry/angle.h"
#include "voxlist/geometry/seconds_between.h"

namespace voxlist::scanner {
namespace {

// For so long a slip is told after it was put right (s): HEALTH goes out once a second, so a person
// who watches it sees it a few times.
constexpr double kTellSlip_s = 5.0;

// Before the first arm, lines that are still for so long (us) mean that the mirror seems to stand.
// A turn takes 2 s at the usual speed, so an arm would have come.
constexpr double kNeverTurned_us = 3e6;

double degrees(double angle_rad) { return angle_rad * 180.0 / std::numbers::pi; }

double turn_s(double rate_radps) { return kTurn_rad / std::abs(rate_radps); }

std::string no_arm_sentence(const MirrorEvidence& evidence) {
  return fmt::format("no arm seen for {:.1f} s", *evidence.silence.silent_s(evidence.now_us));
}

std::string wrong_rate_sentence(const MirrorEvidence& evidence) {
  return fmt::format(
      "wrong rate: a turn takes {:.3f} s by the arms, {:.3f} s by the clock and "
      "steps_per_revolution; going on with the arms",
      turn_s(evidence.arms.rate_radps()), turn_s(evidence.clock.rate_radps()));
}

std::string missing_arm_sentence(const MirrorEvidence& evidence) {
  const std::size_t arm = *evidence.missing_arm();
  return fmt::format("arm {} ({:.0f} deg) not seen for more than two turns: going on without it",
                     arm, degrees(evidence.config.arms[arm].angle_rad));
}

}  // namespace

MirrorTrouble why_searching(const MirrorEvidence& evidence) {
  if (evidence.new_rate) return MirrorTrouble::kNewRate;
  if (evidence.arms.strange_gap_rad()) return MirrorTrouble::kStrangeArmGap;
  if (!evidence.silence.silent_s(evidence.now_us)) {
    return evidence.stall.still_us() > kNeverTurned_us ? MirrorTrouble::kNeverTurned
                                                       : MirrorTrouble::kNoArmYet;
  }
  return evidence.arms_silent() ? MirrorTrouble::kNoArmLately : MirrorTrouble::kTooFewPassages;
}

MirrorTrouble fault(const MirrorEvidence& evidence) {
  const MirrorClockConfig& config = evidence.config;
  if (evidence.arms.direction() != config.direction()) return MirrorTrouble::kReversed;
  if (evidence.wrong_rate()) return MirrorTrouble::kWrongRate;
  if (config.has_clock && !evidence.clock.running(evidence.now_us))
    return MirrorTrouble::kClockLost;
  if (config.has_clock && !evidence.clock_in_step()) return MirrorTrouble::kClockNotInStep;
  if (evidence.slip && seconds_between(evidence.slip->utime_us, evidence.now_us) < kTellSlip_s)
    return MirrorTrouble::kMissedSteps;
  if (evidence.arms_silent()) return MirrorTrouble::kArmsSilent;
  if (evidence.missing_arm()) return MirrorTrouble::kArmMissing;
  return MirrorTrouble::kNone;
}

std::string sentence(MirrorTrouble trouble, const MirrorEvidence& evidence) {
  switch (trouble) {
    case MirrorTrouble::kNone:
      break;
    case MirrorTrouble::kStands:
      return fmt::format(
          "the mirror stands: for {:.1f} s nothing turns in the lines or no arm came",
          seconds_between(*evidence.stall.since_us(), evidence.now_us));
    case MirrorTrouble::kNewRate:
      return "the motor's speed has changed: waiting for passages of the arms";
    case MirrorTrouble::kStrangeArmGap:
      return fmt::format("arms are {:.0f} deg apart, which the settings say in neither direction",
                         degrees(*evidence.arms.strange_gap_rad()));
    case MirrorTrouble::kNeverTurned:
      return "no arm seen yet, and the lines do not change: the mirror seems to stand";
    case MirrorTrouble::kNoArmYet:
      return "no arm seen yet";
    case MirrorTrouble::kNoArmLately:
      return no_arm_sentence(evidence);
    case MirrorTrouble::kTooFewPassages:
      return "waiting for more passages of the arms";
    case MirrorTrouble::kReversed:
      return "reversed: the mirror turns against its settings";
    case MirrorTrouble::kWrongRate:
      return wrong_rate_sentence(evidence);
    case MirrorTrouble::kClockLost:
      return "clock lost: going on with the arms";
    case MirrorTrouble::kClockNotInStep:
      return "clock not yet in step: going on with the arms";
    case MirrorTrouble::kMissedSteps:
      return fmt::format("missed {} steps of the motor: the arms came {:.1f} deg late",
                         evidence.slip->steps, degrees(evidence.slip->late_rad));
    case MirrorTrouble::kArmsSilent:
      return no_arm_sentence(evidence) + ": going on with the clock";
    case MirrorTrouble::kArmMissing:
      return missing_arm_sentence(evidence);
  }
  return {};
}

}  // namespace voxlist::scanner
