#pragma once

#include <cstdint>

#include "voxlist/scanner/arms/arm_detector.h"
#include "voxlist/scanner/arms/passage_fit.h"

namespace voxlist::scanner {

/// Jitter of LASER's time stamps (us, standard deviation): what the scan clock leaves of an
/// adapter's 16 ms. A greater value makes the mirror's angle less sure than it is; a smaller one
/// takes stamps that are a little off for a mirror that has slipped.
inline constexpr double kStampJitter_us = 300.0;

/// Options for fitting passages of a mirror that turns at about this rate: jitter of their times is
/// noise of their angles.
PassageFit::Options passage_fit_options(double rate_radps);

/// The span between two angles in whichever order.
PassageAngles::Span span_between(double a_rad, double b_rad);

/// A passage by a reference that turns, as MirrorTrack takes it: `enter` and `leave` are the
/// reference's angles then, of which the arm's own is taken away; `time_s` is since `origin_us`.
PassageAngles passage_angles(const ArmPassage& passage, const BlockingArm& arm,
                             std::int64_t origin_us, const PassageAngles::Span& enter,
                             const PassageAngles::Span& leave);

}  // namespace voxlist::scanner
