#include "voxlist/calibration/steady_mirror.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace voxlist::calibration {
namespace {

constexpr double kRate_radps = 3.0;
constexpr std::int64_t kPeriod_us = 13'333;

MirrorState locked(int index, double off_rad) {
  MirrorState state;
  state.utime_us = index * kPeriod_us;
  state.state = MirrorState::State::kLocked;
  state.angle_known = true;
  state.rate_radps = kRate_radps;
  state.step_rad = 0.0157;
  state.angle_rad =
      std::fmod(kRate_radps * index * kPeriod_us * 1e-6 + off_rad + 0.1, 2.0 * std::numbers::pi);
  return state;
}

// 1000 states whose angle comes to the truth at last.
std::vector<MirrorState> converging() {
  std::vector<MirrorState> states;
  for (int i = 0; i < 1000; ++i) states.push_back(locked(i, 0.01 * (999 - i) / 999.0));
  return states;
}

double error_rad(const MirrorState& state) {
  const double truth = kRate_radps * static_cast<double>(state.utime_us) * 1e-6 + 0.1;
  return std::remainder(state.angle_rad - truth, 2.0 * std::numbers::pi);
}

TEST(SteadyMirror, GivesAStretchTheLineOfItsLastState) {
  const SteadyMirror mirror = steadied(converging());
  ASSERT_EQ(mirror.states.size(), 1000u);
  for (const MirrorState& state : mirror.states) EXPECT_NEAR(error_rad(state), 0.0, 1e-9);
}

TEST(SteadyMirror, TellsTheWanderOfTheLaterHalf) {
  EXPECT_NEAR(steadied(converging()).wander_rad, 0.005 / std::sqrt(3.0), 1e-4);
}

TEST(SteadyMirror, LeavesOutTheSecondBeforeItBreaksOff) {
  auto states = converging();
  states.push_back(locked(1000, 1.0));
  const SteadyMirror mirror = steadied(states);
  ASSERT_EQ(mirror.states.size(), 1000u - 76u + 1u);
  EXPECT_LT(mirror.states[923].utime_us, states[999].utime_us - 980'000);
  EXPECT_EQ(mirror.states[924].utime_us, states[1000].utime_us);
}

TEST(SteadyMirror, LeavesOutWhatIsNotLocked) {
  auto states = converging();
  for (int i = 0; i < 500; ++i)
    states[static_cast<std::size_t>(i)].state = MirrorState::State::kFault;
  EXPECT_EQ(steadied(states).states.size(), 500u);
}

TEST(SteadyMirror, KeepsStatesWithoutAClockAsTheyAre) {
  auto states = converging();
  for (MirrorState& state : states) state.step_rad = 0.0;
  const SteadyMirror mirror = steadied(states);
  ASSERT_EQ(mirror.states.size(), 1000u);
  EXPECT_EQ(mirror.states.front().angle_rad, states.front().angle_rad);
}

}  // namespace
}  // namespace voxlist::calibration
