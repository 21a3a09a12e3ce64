#include "voxlist/scanner/arms/arm_silence.h"

#include <cmath>

#include "voxlist/geometry/angle.h"
#include "voxlist/geometry/pose.h"
#include "voxlist/geometry/seconds_between.h"

namespace voxlist::scanner {
namespace {

// An arm is missing after so many turns without it: one passage may be lost in a hole. All arms are
// silent after so many gaps between two arms. Fewer would tell a mirror that slows down a little;
// more would tell a stall later.
constexpr double kMissingTurns = 2.5, kSilentGaps = 1.5;

// A hole in LASER longer than this (us): an arm can pass unseen while three lines in a row are
// lost.
constexpr std::int64_t kHole_us = 48'000;

double widest_gap_rad(const std::vector<BlockingArm>& arms) {
  if (arms.size() != 2) return kTurn_rad;
  return kTurn_rad - std::abs(wrap_angle(arms[1].angle_rad - arms[0].angle_rad));
}

}  // namespace

ArmSilence::ArmSilence(const std::vector<BlockingArm>& arms)
    : widest_gap_rad_(widest_gap_rad(arms)), last_seen_us_(arms.size()) {}

void ArmSilence::start(std::int64_t utime_us) {
  last_seen_us_.assign(last_seen_us_.size(), utime_us);
  any_seen_us_.reset();
  looking_since_us_ = last_look_us_ = utime_us;
}

void ArmSilence::passed(const ArmPassage& passage) {
  any_seen_us_ = last_seen_us_[passage.arm] = passage.middle_us();
}

std::optional<double> ArmSilence::silent_s(std::int64_t now_us) const {
  if (!any_seen_us_) return std::nullopt;
  return seconds_between(*any_seen_us_, now_us);
}

void ArmSilence::looked(std::int64_t utime_us) {
  if (utime_us - last_look_us_ > kHole_us) looking_since_us_ = utime_us;
  last_look_us_ = utime_us;
}

// How long a silence has to be to mean something.
double ArmSilence::silence_s(std::int64_t now_us, double rate_radps) const {
  // An arm that has been missing is not waited for.
  const double gap_rad = missing(now_us, rate_radps) ? kTurn_rad : widest_gap_rad_;
  return kSilentGaps * gap_rad / std::abs(rate_radps);
}

bool ArmSilence::silent(std::int64_t now_us, double rate_radps) const {
  return any_seen_us_ && *silent_s(now_us) > silence_s(now_us, rate_radps);
}

bool ArmSilence::silent_in_view(std::int64_t now_us, double rate_radps) const {
  return silent(now_us, rate_radps) &&
         seconds_between(looking_since_us_, now_us) > silence_s(now_us, rate_radps);
}

std::optional<std::size_t> ArmSilence::missing(std::int64_t now_us, double rate_radps) const {
  if (!any_seen_us_) return std::nullopt;
  for (std::size_t arm = 0; arm < last_seen_us_.size(); ++arm) {
    const double unseen_s = seconds_between(last_seen_us_[arm], now_us);
    if (unseen_s > kMissingTurns * kTurn_rad / std::abs(rate_radps)) return arm;
  }
  return std::nullopt;
}

}  // namespace voxlist::scanner
