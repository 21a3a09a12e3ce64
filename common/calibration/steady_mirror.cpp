#include "voxlist/calibration/steady_mirror.h"

#include <cmath>
#include <cstdint>
#include <span>

#include "voxlist/geometry/angle.h"
#include "voxlist/geometry/pose.h"

namespace voxlist::calibration {
namespace {

// A stretch of states breaks off at a hole longer than this (us), at an angle that is off the last
// one's line by more than this (rad), and at another rate by more than this share: the motor was
// given another speed, or slipped.
constexpr std::int64_t kMaxGap_us = 500'000;
constexpr double kMaxJump_rad = 2.0 * kRadPerDeg;
constexpr double kMaxRateChange = 0.01;

// The end of a stretch that is left out (us): mirror_monitor tells a stall or slip up to a second
// late.
constexpr std::int64_t kDoubtful_us = 1'000'000;

bool is_locked(const MirrorState& state) {
  return state.state == MirrorState::State::kLocked && state.angle_known;
}

double angle_at(const MirrorState& state, std::int64_t utime_us) {
  return state.angle_rad + state.rate_radps * static_cast<double>(utime_us - state.utime_us) * 1e-6;
}

bool continues(const MirrorState& before, const MirrorState& state) {
  return is_locked(state) && state.utime_us - before.utime_us <= kMaxGap_us &&
         std::abs(state.rate_radps - before.rate_radps) <=
             kMaxRateChange * std::abs(before.rate_radps) &&
         std::abs(wrap_angle(state.angle_rad - angle_at(before, state.utime_us))) <= kMaxJump_rad;
}

std::size_t end_of_stretch(const std::vector<MirrorState>& states, std::size_t begin) {
  std::size_t end = begin + 1;
  while (is_locked(states[begin]) && end < states.size() && continues(states[end - 1], states[end]))
    ++end;
  return end;
}

using Stretch = std::span<const MirrorState>;

Stretch without_its_end(Stretch stretch) {
  const std::int64_t broke_us = stretch.back().utime_us;
  while (!stretch.empty() && broke_us - stretch.back().utime_us < kDoubtful_us)
    stretch = stretch.first(stretch.size() - 1);
  return stretch;
}

class Steadier {
 public:
  void add(Stretch stretch) {
    for (std::size_t i = 0; i < stretch.size(); ++i) {
      const MirrorState state = seen_from(stretch.back(), stretch[i]);
      const double off_rad = wrap_angle(state.angle_rad - stretch[i].angle_rad);
      states_.push_back(state);
      if (i < stretch.size() / 2) continue;
      squares_ += off_rad * off_rad;
      ++judged_;
    }
  }

  SteadyMirror result() const {
    return {states_, judged_ > 0 ? std::sqrt(squares_ / judged_) : 0.0};
  }

 private:
  static MirrorState seen_from(const MirrorState& last, MirrorState state) {
    if (last.step_rad <= 0.0) return state;
    state.angle_rad = angle_at(last, state.utime_us);
    state.rate_radps = last.rate_radps;
    return state;
  }

  std::vector<MirrorState> states_;
  double squares_ = 0.0;
  int judged_ = 0;
};

}  // namespace

SteadyMirror steadied(const std::vector<MirrorState>& states) {
  Steadier steadier;
  for (std::size_t begin = 0, end = 0; begin < states.size(); begin = end) {
    end = end_of_stretch(states, begin);
    if (!is_locked(states[begin])) continue;
    const Stretch stretch(states.data() + begin, end - begin);
    steadier.add(end < states.size() ? without_its_end(stretch) : stretch);
  }
  return steadier.result();
}

}  // namespace voxlist::calibration
