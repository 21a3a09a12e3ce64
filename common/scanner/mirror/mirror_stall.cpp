#include "voxlist/scanner/mirror/mirror_stall.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace voxlist::scanner {
namespace {

// Lines are compared over this much of the beam's turn (rad), which is twice the mirror's: enough
// to change most ranges. The lag (us) is kept within what a robot's own motion leaves alone; the
// third is for a mirror whose rate is not known.
constexpr double kCompare_rad = 22.5 * std::numbers::pi / 180.0;
constexpr double kMinCompare_us = 30'000.0, kMaxCompare_us = 800'000.0,
                 kFirstCompare_us = 100'000.0;

double compare_lag_us(std::optional<double> rate_radps) {
  if (!rate_radps) return kFirstCompare_us;
  return std::clamp(kCompare_rad / (2.0 * std::abs(*rate_radps)) * 1e6, kMinCompare_us,
                    kMaxCompare_us);
}

}  // namespace

bool MirrorStall::add(const LaserLine& line, std::optional<double> rate_radps, bool arms_silent) {
  watch_.add(motion_.add(line, compare_lag_us(rate_radps)), line.utime_us);
  const bool stands = watch_.stalled() || (arms_silent && !watch_.moving());
  if (!since_us_ && stands) {
    since_us_ = line.utime_us;
    return true;
  }
  if (watch_.turning()) since_us_.reset();
  return false;
}

void MirrorStall::turned() {
  watch_.turned();
  since_us_.reset();
}

}  // namespace voxlist::scanner
