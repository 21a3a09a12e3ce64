#include "voxlist/scanner/mirror/mirror_answer.h"

#include <cmath>

#include "voxlist/geometry/angle.h"
#include "voxlist/scanner/mirror/mirror_diagnosis.h"

namespace voxlist::scanner {
namespace {

using State = MirrorState::State;

double wrap_turn(double angle_rad) {
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

// Writes the angle into `state` when clock or arms know it.
void answer_angle(const MirrorEvidence& evidence, MirrorState& state) {
  if (clock_is_better(evidence)) {
    answer_by_clock(evidence.clock, state);
  } else if (evidence.arms.locked() && !evidence.arms_silent()) {
    answer_by_arms(evidence.arms, state);
  } else {
    return;
  }
  state.angle_known = true;
}

State state_of(bool angle_known, MirrorTrouble trouble) {
  if (trouble == MirrorTrouble::kStands) return State::kStalled;
  if (!angle_known) return State::kSearching;
  return trouble == MirrorTrouble::kNone ? State::kLocked : State::kFault;
}

}  // namespace

MirrorAnswer mirror_answer(const MirrorEvidence& evidence) {
  MirrorAnswer answer;
  answer.state.utime_us = evidence.now_us;
  if (evidence.stall.since_us()) {
    answer.trouble = MirrorTrouble::kStands;
  } else {
    answer_angle(evidence, answer.state);
    answer.trouble = answer.state.angle_known ? fault(evidence) : why_searching(evidence);
  }
  answer.state.state = state_of(answer.state.angle_known, answer.trouble);
  answer.state.reason = sentence(answer.trouble, evidence);
  return answer;
}

}  // namespace voxlist::scanner
