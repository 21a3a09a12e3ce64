#include "voxlist/scanner/mirror/mirror_track.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "voxlist/geometry/pose.h"

namespace voxlist::scanner {
namespace {

// How far an arm may be from where its settings say, against the other arm (rad, 4 deg): what a
// person measures with a protractor.
constexpr double kArmMisfit_rad = 0.07;

// While the fit has fewer passages than this, its free rate is hardly known: passages may be off by
// so much more (rad).
constexpr std::size_t kYoung = 8;
constexpr double kYoungMisfit_rad = 0.05;

// A passage that is off by so many standard deviations of the noise is no noise.
constexpr double kNoises = 6.0;

// A passage that was off was a wild one when so many that fit come after it. When kMaxOff are off
// and do not agree with each other, nothing that was known holds any more.
constexpr int kFitsAfterWild = 6;
constexpr std::size_t kMaxOff = 4;

void turn_near(PassageAngles& passage, double angle_rad) {
  const double middle = passage.middle_rad();
  const double turn = angle_rad + wrap_angle(middle - angle_rad) - middle;
  for (PassageAngles::Span& span : passage.ends) {
    span.low_rad += turn;
    span.high_rad += turn;
  }
}

PassageAngles::Span common(const PassageAngles::Span& a, const PassageAngles::Span& b) {
  return {std::max(a.low_rad, b.low_rad), std::min(a.high_rad, b.high_rad)};
}

bool is_empty(const PassageAngles::Span& span) { return span.low_rad > span.high_rad; }

}  // namespace

MirrorTrack::MirrorTrack(std::size_t arms, double step_rad, const PassageFit::Options& options)
    : step_rad_(step_rad), options_(options), fit_(arms, options) {}

void MirrorTrack::clear() {
  fit_.clear();
  off_.clear();
  doubtful_ = false;
}

MirrorTrack::Verdict MirrorTrack::start_with(const PassageAngles& passage) {
  clear();
  fit_.add(passage);
  return Verdict::kFirst;
}

MirrorTrack::Verdict MirrorTrack::add(PassageAngles passage) {
  if (fit_.passages() == 0) return start_with(passage);
  turn_near(passage, fit_.middle_rad(passage.time_s));
  const PassageAngles::Span turn = needed_turn(passage);
  const bool off = is_empty(turn) || turn.low_rad > 0.0 || turn.high_rad < 0.0;
  if (!off) {
    doubtful_ = false;
    if (++fits_since_off_ >= kFitsAfterWild) off_.clear();
    fit_.add(passage);
    return Verdict::kFits;
  }
  if (!locked()) return start_with(passage);
  fits_since_off_ = 0;
  off_.push_back(passage);
  if (off_.size() < 2) return Verdict::kOff;
  return settle_slip();
}

// The turns of all that is known which would make the passage fit; empty when none would.
PassageAngles::Span MirrorTrack::needed_turn(const PassageAngles& passage) const {
  if (!fit_.knows(passage.arm)) {
    const double turn = passage.middle_rad() - fit_.middle_rad(passage.time_s);
    return {turn - kArmMisfit_rad, turn + kArmMisfit_rad};
  }
  constexpr double kAny = std::numeric_limits<double>::infinity();
  PassageAngles::Span all{-kAny, kAny};
  const bool young = options_.free_rate && fit_.passages() < kYoung;
  for (std::size_t end = 0; end < 2; ++end) {
    const double x = fit_.end_rad(passage.arm, end, passage.time_s);
    const double slack = kNoises * options_.noise_rad + 3.0 * fit_.end_sd_rad(passage.arm, end) +
                         (young ? kYoungMisfit_rad : 0.0);
    all = common(all,
                 {passage.ends[end].low_rad - x - slack, passage.ends[end].high_rad - x + slack});
  }
  return all;
}

MirrorTrack::Verdict MirrorTrack::settle_slip() {
  PassageAngles::Span all = needed_turn(off_.front());
  for (const PassageAngles& passage : off_) all = common(all, needed_turn(passage));
  if (is_empty(all)) {
    if (off_.size() < kMaxOff) return Verdict::kOff;
    return start_with(PassageAngles(off_.back()));
  }
  slip_rad_ = 0.5 * (all.low_rad + all.high_rad);
  const double steps = step_rad_ > 0.0 ? std::round(slip_rad_ / step_rad_) : 0.0;
  const bool one_whole_step = steps != 0.0 && (steps - 1.0) * step_rad_ < all.low_rad &&
                              (steps + 1.0) * step_rad_ > all.high_rad;
  if (steps != 0.0) slip_rad_ = steps * step_rad_;
  // Known to the step, all that was learnt before still holds.
  if (one_whole_step) fit_.turn(slip_rad_);
  if (!one_whole_step) fit_.clear();
  for (const PassageAngles& passage : off_) fit_.add(passage);
  off_.clear();
  return Verdict::kSlipped;
}

}  // namespace voxlist::scanner
