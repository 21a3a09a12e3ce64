#include "voxlist/scanner/sweep/mirror_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace voxlist::scanner {
namespace {

using Known = MirrorAt::Known;
constexpr double kPi = std::numbers::pi;
constexpr double kStep_rad = 2.0 * kPi / 400.0;
constexpr std::int64_t kReach_us = 50'000;

// A mirror of 0.5 turns a second, forwards or backwards, in steps of 5 ms.
MirrorState turning(std::int64_t utime_us, double direction = 1.0) {
  MirrorState state;
  state.utime_us = utime_us;
  state.state = MirrorState::State::kLocked;
  state.angle_known = true;
  const double angle_rad = direction * kPi * static_cast<double>(utime_us) * 1e-6;
  state.angle_rad = angle_rad - 2.0 * kPi * std::floor(angle_rad / (2.0 * kPi));
  state.rate_radps = direction * kPi;
  state.step_rad = kStep_rad;
  return state;
}

MirrorState lost(std::int64_t utime_us) {
  MirrorState state;
  state.utime_us = utime_us;
  state.state = MirrorState::State::kStalled;
  return state;
}

TEST(MirrorMotion, TurnsOnEvenlyFromItsLastState) {
  MirrorMotion motion(false, kReach_us);
  motion.add(turning(1'000'000));
  for (const std::int64_t t : {950'000, 1'000'000, 1'007'000, 1'050'000}) {
    const MirrorAt at = motion.at(t);
    ASSERT_EQ(at.known, Known::kYes) << t;
    EXPECT_NEAR(at.psi_rad, kPi * static_cast<double>(t) * 1e-6, 1e-9);
    EXPECT_DOUBLE_EQ(at.rate_radps, kPi);
  }
}

TEST(MirrorMotion, StandsBetweenTheEdgesOfAStaircaseInBothDirections) {
  for (const double direction : {1.0, -1.0}) {
    MirrorMotion motion(true, kReach_us);
    motion.add(turning(1'000'000, direction));
    const double start_rad = motion.at(1'000'000).psi_rad;
    EXPECT_NEAR(motion.at(1'004'999 - 10).psi_rad, start_rad, 1e-12);
    EXPECT_NEAR(motion.at(1'005'000).psi_rad, start_rad + direction * kStep_rad, 1e-12);
    EXPECT_NEAR(motion.at(1'012'000).psi_rad, start_rad + direction * 2 * kStep_rad, 1e-12);
    EXPECT_NEAR(motion.at(999'000).psi_rad, start_rad - direction * kStep_rad, 1e-12);
  }
}

TEST(MirrorMotion, WithoutStepsAStaircaseTurnsEvenly) {
  MirrorMotion motion(true, kReach_us);
  MirrorState state = turning(1'000'000);
  state.step_rad = 0.0;
  motion.add(state);
  EXPECT_NEAR(motion.at(1'003'000).psi_rad, 1.003 * kPi, 1e-9);
}

TEST(MirrorMotion, SaysWhetherWaitingMayHelp) {
  MirrorMotion motion(false, kReach_us);
  EXPECT_EQ(motion.at(0).known, Known::kNotYet);
  motion.add(turning(1'000'000));
  EXPECT_EQ(motion.at(1'050'001).known, Known::kNotYet);
  EXPECT_EQ(motion.at(949'999).known, Known::kNever);
  motion.add(turning(1'500'000));
  EXPECT_EQ(motion.at(1'050'001).known, Known::kNever) << "a hole stays one";
  EXPECT_EQ(motion.at(1'450'000).known, Known::kYes);
}

TEST(MirrorMotion, IsLostFromTheStateThatSaysSoToTheNextThatKnows) {
  MirrorMotion motion(false, kReach_us);
  motion.add(turning(1'000'000));
  motion.add(lost(1'010'000));
  motion.add(turning(1'020'000));
  EXPECT_EQ(motion.at(1'009'999).known, Known::kYes);
  EXPECT_EQ(motion.at(1'010'000).known, Known::kLost);
  EXPECT_EQ(motion.at(1'019'999).known, Known::kLost);
  EXPECT_EQ(motion.at(1'020'000).known, Known::kYes);
}

TEST(MirrorMotion, CountsTurnsInBothDirectionsAndAcrossHoles) {
  for (const double direction : {1.0, -1.0}) {
    MirrorMotion motion(false, kReach_us);
    motion.add(turning(0, direction));
    const double start_rad = motion.at(0).psi_rad;
    std::int64_t t = 0;
    for (; t < 10'000'000; t += 100'000) motion.add(turning(t, direction));
    motion.add(turning(15'000'000, direction));
    EXPECT_NEAR(motion.at(15'000'000).psi_rad, start_rad + direction * 15.0 * kPi, 1e-6);
  }
}

TEST(MirrorMotion, TakesStatesInAnyOrder) {
  MirrorMotion motion(false, kReach_us);
  motion.add(turning(1'100'000));
  motion.add(lost(1'000'000));
  EXPECT_EQ(motion.at(1'010'000).known, Known::kLost);
  EXPECT_EQ(motion.at(1'110'000).known, Known::kYes);
}

TEST(MirrorMotion, ForgetsWhatWasWhenTimeStartsAnew) {
  MirrorMotion motion(false, kReach_us);
  motion.add(turning(100'000'000));
  motion.add(turning(5'000'000));
  EXPECT_EQ(motion.at(100'000'000).known, Known::kNotYet);
  EXPECT_EQ(motion.at(5'000'000).known, Known::kYes);
}

}  // namespace
}  // namespace voxlist::scanner
