#include "voxlist/scanner/mirror/mirror_by_clock.h"

#include <cmath>

#include "voxlist/geometry/angle.h"
#include "voxlist/geometry/seconds_between.h"
#include "voxlist/scanner/arms/passage_angles.h"
#include "voxlist/system/check.h"

namespace voxlist::scanner {
namespace {

// Passages after which the phase is as well known as it will be: eight turns of two arms.
constexpr std::size_t kGrownPassages = 16;

}  // namespace

MirrorByClock::MirrorByClock(const MirrorClockConfig& config)
    : config_(config),
      step_rad_(kTurn_rad / config.steps_per_revolution),
      direction_(config.direction()) {}

void MirrorByClock::start(std::int64_t origin_us) {
  track_.reset();
  origin_us_ = origin_us;
}

void MirrorByClock::notice_restart() {
  if (!clock_.ready() || (track_ && generation_ == clock_.generation())) return;
  generation_ = clock_.generation();
  track_.emplace(config_.arms.size(), step_rad_, passage_fit_options(rate_radps()));
}

bool MirrorByClock::changed_rate() {
  const bool changed = clock_.counts().rate_changes != rate_changes_;
  rate_changes_ = clock_.counts().rate_changes;
  return changed && locked();
}

void MirrorByClock::set_direction(double direction) {
  if (direction == direction_) return;
  direction_ = direction;
  track_.reset();
  notice_restart();
}

MirrorByClock::Verdict MirrorByClock::add(const ArmPassage& passage) {
  if (!track_ || !clock_.running(passage.middle_us())) return {};
  const bool was_locked = track_->locked();
  const MirrorTrack::Verdict verdict = track_->add(passage_angles(
      passage, config_.arms[passage.arm], origin_us_, span(passage.enter), span(passage.leave)));
  if (verdict == MirrorTrack::Verdict::kFits) return {.fits = true, .slip_rad = {}};
  if (!was_locked) return {};
  if (verdict != MirrorTrack::Verdict::kSlipped) return {.fits = false, .slip_rad = {}};
  return {.fits = false, .slip_rad = track_->slip_rad()};
}

// The least and the greatest angle in a time whose ends are known to some jitter.
PassageAngles::Span MirrorByClock::span(const TimeSpan& time) const {
  double first = clock_.steps_at(time.after_us), last = clock_.steps_at(time.before_us);
  if (config_.staircase) {
    const double jitter = 3.0 * kStampJitter_us / clock_.period_us();
    first = std::floor(first - jitter);
    last = std::floor(last + jitter);
  }
  return span_between(direction_ * step_rad_ * first, direction_ * step_rad_ * last);
}

void MirrorByClock::doubt() {
  if (track_) track_->doubt();
}

bool MirrorByClock::grown() const { return track_ && track_->passages() >= kGrownPassages; }

MirrorByClock::Stop MirrorByClock::stop_before(std::int64_t utime_us) const {
  VOXLIST_CHECK(locked(), "the angle is asked for before passages fit the clock");
  const auto step = static_cast<std::int64_t>(std::floor(clock_.steps_at(utime_us)));
  const std::int64_t edge_us = clock_.edge_us(step);
  const auto in_turn = static_cast<double>(step % config_.steps_per_revolution);
  return {edge_us, direction_ * step_rad_ * in_turn +
                       track_->offset_rad(seconds_between(origin_us_, edge_us))};
}

double MirrorByClock::residual_rad() const {
  VOXLIST_CHECK(locked(), "the residual is asked for before passages fit the clock");
  return track_->residual_rad();
}

double MirrorByClock::rate_radps() const {
  VOXLIST_CHECK(ready(), "the rate is asked for before the clock's period is known");
  return direction_ * step_rad_ / (clock_.period_us() * 1e-6);
}

}  // namespace voxlist::scanner
