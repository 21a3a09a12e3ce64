#include "voxlist/scanner/mirror/mirror_clock.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>
#include <string>

#include "tests/scanner/mirror/synthetic_mirror.h"

namespace voxlist::scanner {
namespace {

using State = MirrorState::State;

// Errors from `start_s` on, at the middle of each line.
struct Errors {
  double rms_deg = 0.0, mean_deg = 0.0, max_deg = 0.0, residual_deg = 0.0;
  int known = 0, lines = 0;
  double first_known_s = -1.0;
  std::set<std::string> reasons;

  // About the mean, which calibration takes away.
  double sd_deg() const {
    return std::sqrt(std::max(0.0, rms_deg * rms_deg - mean_deg * mean_deg));
  }
};

Errors errors(MirrorRun& run, double start_s, double end_s) {
  Errors e;
  run.until(end_s, [&](double time_s, const MirrorState& state) {
    if (state.angle_known && e.first_known_s < 0.0) e.first_known_s = time_s;
    if (time_s < start_s) return;
    ++e.lines;
    if (!state.reason.empty()) e.reasons.insert(state.reason);
    if (!state.angle_known) return;
    ++e.known;
    const double off_deg = run.error_rad(time_s + 0.0033, state) / kDeg;
    e.rms_deg += off_deg * off_deg;
    e.mean_deg += off_deg;
    e.max_deg = std::max(e.max_deg, std::abs(off_deg));
    e.residual_deg = state.residual_rad / kDeg;
  });
  e.rms_deg = std::sqrt(e.rms_deg / e.known);
  e.mean_deg /= e.known;
  return e;
}

void print(const std::string& what, const Errors& e) {
  std::printf(
      "%-44s known after %5.2f s, then RMS %.4f deg (mean %+.4f, max %.3f), residual %.4f\n",
      what.c_str(), e.first_known_s, e.rms_deg, e.mean_deg, e.max_deg, e.residual_deg);
}

MirrorRun make_run(double revolution_s, bool clock = true, bool staircase = false) {
  SyntheticMirror mirror;
  mirror.revolution_s = revolution_s;
  mirror.staircase = staircase;
  MirrorClockConfig config = MirrorRun::usual_config();
  config.has_clock = clock;
  config.staircase = staircase;
  MirrorRun run(mirror, config);
  run.clock_runs = clock;
  return run;
}

std::string name(double revolution_s, const char* with) {
  char text[80];
  std::snprintf(text, sizeof text, "1/%.1f turns/s, %s:", revolution_s, with);
  return text;
}

// One beat of the lines against the mirror is 33 s at 0.5 turns a second: then every part of the
// gap between two lines has been seen.
constexpr double kStart_s = 40.0;

TEST(MirrorClock, KnowsTheAngleToATwentiethOfADegreeWithTheClock) {
  for (const double revolution_s : {1.0, 2.0, 3.0, 6.0, 9.6}) {
    MirrorRun run = make_run(revolution_s);
    const Errors e = errors(run, kStart_s, 140.0);
    print(name(revolution_s, "with clock"), e);
    EXPECT_EQ(e.known, e.lines);
    EXPECT_LE(e.rms_deg, 0.05);
    EXPECT_TRUE(e.reasons.empty()) << *e.reasons.begin();
    EXPECT_NEAR(run.clock.clock_period_us(), revolution_s * 1e6 / 400.0, 1.0);
  }
}

TEST(MirrorClock, KnowsTheAngleToAFifthOfADegreeWithArmsAlone) {
  for (const double revolution_s : {1.0, 2.0, 3.0, 6.0, 9.6}) {
    MirrorRun run = make_run(revolution_s, false);
    const Errors e = errors(run, kStart_s, 140.0);
    print(name(revolution_s, "arms alone"), e);
    EXPECT_EQ(e.known, e.lines);
    EXPECT_LE(e.rms_deg, 0.2);
    EXPECT_TRUE(e.reasons.empty()) << *e.reasons.begin();
  }
}

// The arms tell which stops they block, so the angle is known but for a part of a step that never
// changes.
TEST(MirrorClock, KnowsTheStopsOfAStaircaseButForAConstant) {
  for (const double revolution_s : {2.0, 6.0, 9.6}) {
    MirrorRun run = make_run(revolution_s, true, true);
    SyntheticMirror& mirror = run.mirror;
    mirror.edge_jitter_us = 50.0;  // so that truth's stop and ours are the same one
    const Errors e = errors(run, kStart_s, 140.0);
    print(name(revolution_s, "staircase"), e);
    EXPECT_LE(e.sd_deg(), 0.05);
    EXPECT_LE(std::abs(e.mean_deg), 0.23);
    EXPECT_GE(e.residual_deg, 0.5 * std::abs(e.mean_deg));
  }
}

TEST(MirrorClock, SaysThatLinesInStepWithTheMirrorHideAPartOfTheAngle) {
  for (const bool clock : {true, false}) {
    MirrorRun run = make_run(2.0, clock);
    run.mirror.line_hz = 75.0;  // 150 lines a turn, always the same ones
    const Errors e = errors(run, kStart_s, 140.0);
    print(clock ? "exactly 75 Hz, with clock:" : "exactly 75 Hz, arms alone:", e);
    EXPECT_LE(e.rms_deg, 1.2);
    EXPECT_GE(e.residual_deg, e.rms_deg);
    EXPECT_GE(e.residual_deg, 0.2);
  }
}

TEST(MirrorClock, NeedsOnlyOneArm) {
  for (const bool clock : {true, false}) {
    MirrorRun run = make_run(2.0, clock);
    run.mirror.arms.pop_back();
    MirrorClockConfig config = run.config;
    config.arms.pop_back();
    MirrorRun one(run.mirror, config);
    one.clock_runs = clock;
    const Errors e = errors(one, kStart_s, 140.0);
    print(clock ? "one arm, with clock:" : "one arm alone:", e);
    EXPECT_LE(e.rms_deg, clock ? 0.05 : 0.2);
    EXPECT_TRUE(e.reasons.empty());
  }
}

TEST(MirrorClock, CountsHalfTurnsWithTheirSign) {
  for (const double direction : {1.0, -1.0}) {
    SyntheticMirror mirror;
    mirror.direction = direction;
    MirrorClockConfig config = MirrorRun::usual_config();
    config.turns_backwards = direction < 0.0;
    MirrorRun run(mirror, config);
    MirrorState last;
    double first_s = -1.0;
    run.until(30.0, [&](double time_s, const MirrorState& state) {
      if (state.angle_known && first_s < 0.0) first_s = time_s;
      last = state;
    });
    EXPECT_EQ(last.state, State::kLocked) << last.reason;
    EXPECT_NEAR(last.rate_radps, direction * std::numbers::pi, 1e-3);
    EXPECT_EQ(last.half_revolutions,
              static_cast<std::int64_t>(direction * std::floor(30.0 - first_s)));
    EXPECT_NEAR(last.step_rad, 0.9 * kDeg, 1e-12);
  }
}

// ---- stalls

double stall_delay_s(MirrorRun& run, double stall_s) {
  run.mirror.standing_s = [stall_s](double time_s) {
    return std::clamp(time_s - stall_s, 0.0, 4.3);
  };
  double told_s = 1e9, back_s = 1e9;
  int wrong = 0;
  run.until(stall_s + 12.0, [&](double time_s, const MirrorState& state) {
    if (time_s < stall_s) {
      wrong += state.state == State::kStalled;
    } else if (state.state == State::kStalled) {
      EXPECT_FALSE(state.angle_known);
      told_s = std::min(told_s, time_s - stall_s);
    } else if (state.angle_known && time_s > stall_s + 4.3) {
      // Only an arm tells where it is now.
      wrong += std::abs(run.error_rad(time_s, state)) > 4.0 * kDeg;
      back_s = std::min(back_s, time_s - stall_s - 4.3);
    }
  });
  EXPECT_EQ(wrong, 0) << stall_s;
  EXPECT_LT(back_s, 4.0) << stall_s;
  return told_s;
}

TEST(MirrorClock, ReportsAStallWithinHalfASecond) {
  double worst_s = 0.0;
  for (const double share : {0.0, 1.0}) {
    for (const bool clock : {true, false}) {
      for (double stall_s = 20.0; stall_s < 22.0; stall_s += 0.135) {
        MirrorRun run = make_run(2.0, clock);
        run.mirror.room = true;
        run.mirror.speed_mps = 0.5 * share;
        run.mirror.turn_degps = 45.0 * share;
        worst_s = std::max(worst_s, stall_delay_s(run, stall_s));
      }
    }
  }
  std::printf("stall in a room, standing and driving: told after %.3f s at the latest\n", worst_s);
  EXPECT_LE(worst_s, 0.5);
}

TEST(MirrorClock, ReportsAStallByTheArmsWhereLinesTellNothing) {
  MirrorRun run = make_run(2.0);  // all walls are equally far
  const double delay_s = stall_delay_s(run, 20.3);
  std::printf("stall where lines tell nothing: told after %.3f s\n", delay_s);
  EXPECT_LE(delay_s, 1.7);
}

TEST(MirrorClock, RaisesNoFalseAlarmInTenMinutes) {
  for (const double share : {0.0, 1.0}) {
    MirrorRun run = make_run(2.0);
    run.mirror.room = true;
    run.mirror.sky = share > 0.0;
    run.mirror.speed_mps = 0.5 * share;
    run.mirror.turn_degps = 45.0 * share;
    run.mirror.dazzled = 0.02;
    run.mirror.spurious = 0.003;
    run.mirror.lost_lines = 0.02;
    run.mirror.lost_edges = 0.05;
    run.mirror.doubled_edges = 0.02;
    const Errors e = errors(run, 3.0, 600.0);
    print(share > 0.0 ? "ten minutes, driving, no sky:" : "ten minutes in a room:", e);
    EXPECT_TRUE(e.reasons.empty()) << *e.reasons.begin();
    EXPECT_EQ(e.known, e.lines);
    EXPECT_EQ(run.clock.counts().missed_steps, 0);
    EXPECT_EQ(run.clock.counts().clock_restarts, 0);
    EXPECT_LT(run.clock.counts().strange_arm_events, 5);
    EXPECT_NEAR(static_cast<double>(run.clock.counts().lost_edges), 6000.0, 300.0);
  }
}

// ---- faults

// When the state first has a reason that begins so, in seconds since `since_s`.
double told_after_s(MirrorRun& run, double since_s, double end_s, const std::string& begin,
                    bool known = true) {
  double told_s = 1e9;
  run.until(end_s, [&](double time_s, const MirrorState& state) {
    if (time_s < since_s || told_s < 1e9 || !state.reason.starts_with(begin)) return;
    EXPECT_EQ(state.state, State::kFault);
    EXPECT_EQ(state.angle_known, known);
    told_s = time_s - since_s;
  });
  return told_s;
}

TEST(MirrorClock, ReportsMissedStepsAndGoesOnWithTheRightAngle) {
  for (const int missed : {1, 3, 8, 40}) {
    MirrorRun run = make_run(2.0);
    errors(run, 0.0, 60.0);
    run.mirror.standing_s = [missed](double time_s) {
      return time_s < 60.0 ? 0.0 : 0.005 * missed;
    };
    const double told_s =
        told_after_s(run, 60.0, 110.0, "missed " + std::to_string(missed) + " step");
    std::printf("%d missed steps: told after %.1f s\n", missed, told_s);
    EXPECT_LT(told_s, missed >= 8 ? 2.5 : 45.0);
    EXPECT_EQ(run.clock.counts().missed_steps, missed);
    const Errors after = errors(run, 110.0, 160.0);
    EXPECT_LE(after.rms_deg, 0.05) << missed;
    EXPECT_TRUE(after.reasons.empty());
  }
}

TEST(MirrorClock, FindsAClockThatDoesNotFitTheArms) {
  for (const int steps : {200, 800, 390}) {
    MirrorRun run = make_run(2.0);
    run.config.steps_per_revolution = steps;
    MirrorRun wrong(run.mirror, run.config);
    EXPECT_LT(told_after_s(wrong, 0.0, 20.0, "wrong rate"), 12.0) << steps;
    const Errors e = errors(wrong, kStart_s, 80.0);
    EXPECT_LE(e.rms_deg, 0.2) << steps;
  }
}

TEST(MirrorClock, GoesOnWithoutAnArmThatIsMissing) {
  for (const std::size_t arm : {0u, 1u}) {
    MirrorRun run = make_run(2.0);
    errors(run, 0.0, 60.0);
    run.mirror.arms[arm].there = false;
    const double told_s = told_after_s(run, 60.0, 70.0, "arm " + std::to_string(arm));
    EXPECT_LT(told_s, 6.1);
    const Errors e = errors(run, 70.0, 120.0);
    EXPECT_LE(e.rms_deg, 0.05);
    EXPECT_EQ(e.known, e.lines);
    run.mirror.arms[arm].there = true;
    const Errors again = errors(run, 124.0, 140.0);
    EXPECT_TRUE(again.reasons.empty());
  }
}

TEST(MirrorClock, GoesOnByTheClockWhileTheMirrorTurnsWithoutArms) {
  MirrorRun run = make_run(2.0);
  run.mirror.room = true;
  errors(run, 0.0, 60.0);
  run.mirror.arms[0].there = run.mirror.arms[1].there = false;
  EXPECT_LT(told_after_s(run, 60.0, 65.0, "no arm seen"), 2.0);
  const Errors e = errors(run, 65.0, 100.0);
  EXPECT_EQ(e.known, e.lines);
  EXPECT_LE(e.rms_deg, 0.05);
}

TEST(MirrorClock, GoesOnWithTheArmsWhenTheClockIsLostAndTakesItUpAgain) {
  MirrorRun run = make_run(2.0);
  errors(run, 0.0, 60.0);
  run.clock_runs = false;
  EXPECT_LT(told_after_s(run, 60.0, 61.0, "clock lost"), 0.4);
  const Errors alone = errors(run, 61.0, 90.0);
  print("clock lost:", alone);
  EXPECT_EQ(alone.known, alone.lines);
  EXPECT_LE(alone.rms_deg, 0.2);
  run.clock_runs = true;
  const Errors again = errors(run, 95.0, 180.0);
  print("clock back:", again);
  EXPECT_EQ(again.known, again.lines);
  EXPECT_TRUE(again.reasons.empty()) << *again.reasons.begin();
  EXPECT_LE(errors(run, 180.0, 200.0).rms_deg, 0.05);
}

TEST(MirrorClock, FindsThatTheMirrorTurnsTheOtherWay) {
  for (const bool clock : {true, false}) {
    MirrorRun run = make_run(2.0, clock);
    run.mirror.direction = -1.0;
    EXPECT_LT(told_after_s(run, 0.0, 10.0, "reversed"), 6.0);
    const Errors e = errors(run, kStart_s, 80.0);
    EXPECT_EQ(e.known, e.lines);
    EXPECT_LE(e.rms_deg, clock ? 0.05 : 0.2);
  }
}

TEST(MirrorClock, SaysWhatItWaitsFor) {
  MirrorRun run = make_run(2.0);
  run.mirror.arms[0].there = run.mirror.arms[1].there = false;
  MirrorState last;
  run.until(5.0, [&](double, const MirrorState& state) { last = state; });
  EXPECT_EQ(last.state, State::kSearching);
  EXPECT_FALSE(last.angle_known);
  EXPECT_EQ(last.reason.find("no arm seen yet"), 0u) << last.reason;
}

TEST(MirrorClock, StartsAnewWhenTheWallClockJumps) {
  for (const std::int64_t jump_us : {-3'600'000'000LL, 86'400'000'000LL}) {
    MirrorRun run = make_run(2.0);
    errors(run, 0.0, 60.0);
    run.origin_us += jump_us;
    int known_wrongly = 0;
    run.until(100.0, [&](double time_s, const MirrorState& state) {
      known_wrongly += state.angle_known && std::abs(run.error_rad(time_s, state)) > 4.0 * kDeg;
    });
    EXPECT_EQ(known_wrongly, 0);
    EXPECT_EQ(run.clock.counts().time_jumps, 1);
    const Errors e = errors(run, 100.0, 140.0);
    EXPECT_EQ(e.known, e.lines);
    EXPECT_LE(e.rms_deg, 0.05);
  }
}

}  // namespace
}  // namespace voxlist::scanner
