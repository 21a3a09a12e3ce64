#include "voxlist/scanner/mirror/mirror_by_arms.h"

#include <cmath>

#include "voxlist/geometry/angle.h"
#include "voxlist/geometry/elementary.h"
#include "voxlist/geometry/seconds_between.h"
#include "voxlist/scanner/arms/passage_angles.h"
#include "voxlist/system/check.h"

namespace voxlist::scanner {
namespace {

// Passages older than this (s) are dropped: the wall clock is corrected now and then, and a line
// under even time bends there.
constexpr double kMaxAge_s = 120.0;

// Passages after which the arms' rate may be held against the clock's: two turns of two arms. With
// fewer it is known to a few per cent only.
constexpr std::size_t kRatePassages = 4;

}  // namespace

MirrorByArms::MirrorByArms(const MirrorClockConfig& config)
    : config_(config), direction_(config.direction()), arm_rate_(config.arms, config.direction()) {}

void MirrorByArms::start(std::int64_t origin_us) {
  arm_rate_.reset();
  track_.reset();
  origin_us_ = origin_us;
}

std::optional<bool> MirrorByArms::add(const ArmPassage& passage) {
  const std::optional<double> rate = arm_rate_.add(passage);
  if (track_) {
    const MirrorTrack::Verdict verdict = follow(passage);
    if (verdict != MirrorTrack::Verdict::kFirst) return verdict == MirrorTrack::Verdict::kFits;
    track_.reset();
  }
  if (!rate) return std::nullopt;
  start_track(*rate);
  return track_->locked();
}

void MirrorByArms::start_track(double rate_radps) {
  direction_ = std::copysign(1.0, rate_radps);
  even_rate_radps_ = rate_radps;
  even_origin_us_ = arm_rate_.passages().front().middle_us();
  PassageFit::Options options = passage_fit_options(rate_radps);
  options.free_rate = true;
  options.max_age_s = kMaxAge_s;
  track_.emplace(config_.arms.size(), 0.0, options);
  for (const ArmPassage& passage : arm_rate_.passages()) follow(passage);
}

MirrorTrack::Verdict MirrorByArms::follow(const ArmPassage& passage) {
  const auto span = [this](const TimeSpan& time) {
    return span_between(even_angle_rad(time.after_us), even_angle_rad(time.before_us));
  };
  return track_->add(passage_angles(passage, config_.arms[passage.arm], origin_us_,
                                    span(passage.enter), span(passage.leave)));
}

double MirrorByArms::even_angle_rad(std::int64_t utime_us) const {
  return even_rate_radps_ * seconds_between(even_origin_us_, utime_us);
}

void MirrorByArms::doubt() {
  arm_rate_.reset();
  if (track_) track_->doubt();
}

bool MirrorByArms::rate_is_sure() const { return locked() && track_->passages() >= kRatePassages; }

double MirrorByArms::rate_radps() const {
  VOXLIST_CHECK(locked(), "the arms' rate is asked for before passages fit each other");
  return even_rate_radps_ + track_->rate_radps();
}

double MirrorByArms::angle_rad(std::int64_t utime_us) const {
  VOXLIST_CHECK(locked(), "the angle is asked for before passages fit each other");
  return even_angle_rad(utime_us) + track_->offset_rad(seconds_between(origin_us_, utime_us));
}

// Without a clock nobody knows on which stop of its stair the mirror stands.
double MirrorByArms::residual_rad() const {
  VOXLIST_CHECK(locked(), "the residual is asked for before passages fit each other");
  const double step_rad = kTurn_rad / config_.steps_per_revolution;
  const double stair_rad = config_.staircase ? step_rad / std::sqrt(12.0) : 0.0;
  return elementary::hypot(track_->residual_rad(), stair_rad);
}

}  // namespace voxlist::scanner
