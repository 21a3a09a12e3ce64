#include "voxlist/scanner/sweep/mirror_motion.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "voxlist/geometry/pose.h"

namespace voxlist::scanner {
namespace {

// States that are kept: 2.7 s at the rate of the laser's lines, far more than a line may wait.
constexpr std::size_t kCapacity = 200;

constexpr auto kIsBefore = [](std::int64_t utime_us, const MirrorState& state) {
  return utime_us < state.utime_us;
};

double seconds_since(const MirrorState& state, std::int64_t utime_us) {
  return static_cast<double>(utime_us - state.utime_us) * 1e-6;
}

// The state's angle with the turns that make it follow on an earlier or later state.
double unwrapped(const MirrorState& state, const MirrorState& neighbour) {
  const double expected =
      neighbour.angle_rad + neighbour.rate_radps * seconds_since(neighbour, state.utime_us);
  return expected + wrap_angle(state.angle_rad - expected);
}

}  // namespace

void MirrorMotion::add(const MirrorState& state) {
  if (!states_.empty() && states_.back().utime_us - state.utime_us > kTimeStartsAnew_us)
    states_.clear();
  auto later = std::upper_bound(states_.begin(), states_.end(), state.utime_us, kIsBefore);
  MirrorState added = state;
  // States without an angle hand on the last one, so that turns are counted across them.
  if (later != states_.begin()) {
    const MirrorState& before = *std::prev(later);
    added.angle_rad = state.angle_known ? unwrapped(state, before) : before.angle_rad;
    if (!state.angle_known) added.rate_radps = 0.0;
    if (before.utime_us == state.utime_us) later = states_.erase(std::prev(later));
  } else if (later != states_.end()) {
    added.angle_rad = unwrapped(state, *later);
  }
  states_.insert(later, added);
  if (states_.size() > kCapacity) states_.pop_front();
}

MirrorAt MirrorMotion::at(std::int64_t utime_us) const {
  const auto later = std::upper_bound(states_.begin(), states_.end(), utime_us, kIsBefore);
  const bool has_before = later != states_.begin(), has_after = later != states_.end();
  if (has_before && utime_us - std::prev(later)->utime_us <= max_extrapolation_us_)
    return moved(*std::prev(later), utime_us);
  if (has_after && later->utime_us - utime_us <= max_extrapolation_us_)
    return moved(*later, utime_us);
  return {has_after ? MirrorAt::Known::kNever : MirrorAt::Known::kNotYet};
}

MirrorAt MirrorMotion::moved(const MirrorState& state, std::int64_t utime_us) const {
  if (!state.angle_known) return {MirrorAt::Known::kLost};
  const double turned_rad = state.rate_radps * seconds_since(state, utime_us);
  if (!staircase_ || state.step_rad <= 0.0)
    return {MirrorAt::Known::kYes, state.angle_rad + turned_rad, state.rate_radps};
  // Both times are rounded to microseconds: none of them may miss an edge by that.
  const double since_s = seconds_since(state, utime_us) + 1e-6;
  const double steps = std::floor(std::abs(state.rate_radps) * since_s / state.step_rad);
  const double stepped_rad = std::copysign(state.step_rad, state.rate_radps) * steps;
  return {MirrorAt::Known::kYes, state.angle_rad + stepped_rad, state.rate_radps};
}

}  // namespace voxlist::scanner
