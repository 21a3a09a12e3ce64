#include "voxlist/scanner/arms/passage_angles.h"

#include <algorithm>
#include <cmath>

#include "voxlist/geometry/seconds_between.h"

namespace voxlist::scanner {
namespace {

// What is not perfect in an arm itself: 0.01 deg, below anything that calibration can tell (rad).
constexpr double kMinNoise_rad = 2e-4;

}  // namespace

PassageFit::Options passage_fit_options(double rate_radps) {
  PassageFit::Options options;
  options.noise_rad = kMinNoise_rad + std::abs(rate_radps) * kStampJitter_us * 1e-6;
  return options;
}

PassageAngles::Span span_between(double a_rad, double b_rad) {
  return {std::min(a_rad, b_rad), std::max(a_rad, b_rad)};
}

PassageAngles passage_angles(const ArmPassage& passage, const BlockingArm& arm,
                             std::int64_t origin_us, const PassageAngles::Span& enter,
                             const PassageAngles::Span& leave) {
  PassageAngles result{
      passage.arm, seconds_between(origin_us, passage.middle_us()), {enter, leave}};
  for (PassageAngles::Span& end : result.ends) {
    end.low_rad -= arm.angle_rad;
    end.high_rad -= arm.angle_rad;
  }
  return result;
}

}  // namespace voxlist::scanner
