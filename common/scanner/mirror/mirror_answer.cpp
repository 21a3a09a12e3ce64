#include "voxlist/scanner/mirror/mirror_answer.h"

#include <cmath>
#include <numbers>

#include "voxlist/scanner/mirror/mirror_diagnosis.h"

namespace voxlist::scanner {
namespace {

using State = MirrorState::State;

double wrap_turn(double angle_rad) {
  constexpr double kTurn_rad = 2.0 * std::numbers::pi;
  const double a = std::fmod(angle_rad, kTurn_rad);
  return a < 0.0 ? a + kTurn_rad : a;
}

// A clock that has just come back is not yet known as well as the arms' own line.
bool clock_is_better(const MirrorEvidence& evidence) {
  if (!evidence.clock_in_step()) return false;
  return !evidence.arms.locked() || evidence.clock.grown() ||
         evidence.clock.residual_rad() <= evidence.arms.residual_rad();
}

void answer_by_clock(const MirrorByClock& clock, MirrorState& state) {
  const MirrorByClock::Stop stop = clock.stop_before(state.utime_us);
  state.utime_us = stop.utime_us;
  state.angle_rad = wrap_turn(stop.angle_rad);
  state.rate_radps = clock.rate_radps();
  state.step_rad = clock.step_rad();
  state.residual_rad = clock.residual_rad();
}

void answer_by_arms(const MirrorByArms& arms, MirrorState& state) {
  state.angle_rad = wrap_turn(arms.angle_rad(state.utime_us));
  state.rate_radps = arms.rate_radps();
  state.residual_rad = arms.residual_rad();
}

}  // namespace

MirrorState mirror_answer(const MirrorEvidence& evidence) {
  MirrorState state;
  state.utime_us = evidence.now_us;
  if (evidence.stall.since_us()) {
    state.state = State::kStalled;
    state.reason = how_it_stands(evidence);
    return state;
  }
  if (clock_is_better(evidence)) {
    answer_by_clock(evidence.clock, state);
  } else if (evidence.arms.locked() && !evidence.arms_silent()) {
    answer_by_arms(evidence.arms, state);
  } else {
    state.reason = why_searching(evidence);
    return state;
  }
  state.angle_known = true;
  state.reason = what_is_wrong(evidence);
  state.state = state.reason.empty() ? State::kLocked : State::kFault;
  return state;
}

}  // namespace voxlist::scanner
