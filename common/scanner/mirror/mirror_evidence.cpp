#include "voxlist/scanner/mirror/mirror_evidence.h"

#include <cmath>

namespace voxlist::scanner {
namespace {

// Rates of arms and clock that differ by more than this share are two rates: the least that a wrong
// steps_per_revolution makes, 390 for 400, is told. Smaller, and rates that are still rough differ.
constexpr double kRateTolerance = 0.02;

}  // namespace

MirrorEvidence::MirrorEvidence(const MirrorClockConfig& with)
    : config(with), clock(with), arms(with), silence(with.arms) {}

void MirrorEvidence::start(std::int64_t utime_us) {
  clock.start(utime_us);
  arms.start(utime_us);
  silence.start(utime_us);
  stall.reset();
  slip.reset();
  new_rate = false;
}

std::optional<double> MirrorEvidence::rate_radps() const {
  if (arms.locked()) return arms.rate_radps();
  if (clock.ready()) return clock.rate_radps();
  return std::nullopt;
}

bool MirrorEvidence::wrong_rate() const {
  if (!clock.running(now_us) || !arms.rate_is_sure()) return false;
  return std::abs(arms.rate_radps() / clock.rate_radps() - 1.0) > kRateTolerance;
}

bool MirrorEvidence::clock_in_step() const {
  return clock.running(now_us) && clock.locked() && !wrong_rate();
}

bool MirrorEvidence::arms_silent() const {
  const std::optional<double> rate = rate_radps();
  return rate && silence.silent(now_us, *rate);
}

bool MirrorEvidence::arms_silent_in_view() const {
  const std::optional<double> rate = rate_radps();
  return rate && silence.silent_in_view(now_us, *rate);
}

std::optional<std::size_t> MirrorEvidence::missing_arm() const {
  const std::optional<double> rate = rate_radps();
  return rate ? silence.missing(now_us, *rate) : std::nullopt;
}

}  // namespace voxlist::scanner
