// The mirror clock while lines are lost in bursts, time stamps jump, or the motor changes its
// speed: that is no stall.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "tests/scanner/mirror/synthetic_mirror.h"

namespace voxlist::scanner {
namespace {

using State = MirrorState::State;

struct Hole {
  double from_s, to_s;
};

// Holes of up to `longest_s`, with lines between them for a tenth of a second to two.
std::vector<Hole> holes(double longest_s, double from_s, double to_s, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> length(0.02, longest_s), between(0.1, 2.0);
  std::vector<Hole> result;
  for (double t = from_s + between(random); t < to_s; t = result.back().to_s + between(random))
    result.push_back({t, t + length(random)});
  return result;
}

bool inside(const std::vector<Hole>& holes, double time_s) {
  return std::ranges::any_of(
      holes, [&](const Hole& hole) { return time_s >= hole.from_s && time_s < hole.to_s; });
}

MirrorRun run_in_room(bool clock) {
  SyntheticMirror mirror;
  mirror.room = true;
  MirrorClockConfig config = MirrorRun::usual_config();
  config.has_clock = clock;
  MirrorRun run(mirror, config);
  run.clock_runs = clock;
  return run;
}

TEST(MirrorLostLines, AreNoStall) {
  for (const bool clock : {true, false}) {
    for (const double longest_s : {0.15, 0.4, 1.8}) {
      for (unsigned seed = 1; seed <= 2; ++seed) {
        MirrorRun run = run_in_room(clock);
        run.mirror.line_lost = [all = holes(longest_s, 10.0, 70.0, seed)](double time_s) {
          return inside(all, time_s);
        };
        run.until(80.0);
        EXPECT_EQ(run.clock.counts().stalls, 0)
            << (clock ? "with clock, " : "arms alone, ") << longest_s << " s, seed " << seed;
      }
    }
  }
}

// While most lines are lost, at random, whole passages of arms are too.
TEST(MirrorLostLines, AreNoStallWhenHalfOfAllAreLost) {
  for (const double lost : {0.5, 0.7}) {
    for (unsigned seed = 1; seed <= 2; ++seed) {
      MirrorRun run = run_in_room(true);
      run.mirror.random.seed(seed);
      run.until(10.0);
      run.mirror.lost_lines = lost;
      run.until(70.0);
      EXPECT_EQ(run.clock.counts().stalls, 0) << lost << ", seed " << seed;
    }
  }
}

TEST(MirrorLostLines, AreNoStallWhenTimeStampsJumpByATurnOfTheLaser) {
  for (unsigned seed = 1; seed <= 2; ++seed) {
    MirrorRun run = run_in_room(true);
    const std::vector<Hole> late = holes(0.5, 10.0, 70.0, seed);
    const std::vector<Hole> early = holes(0.5, 10.0, 70.0, seed + 100);
    run.mirror.line_lost = [all = holes(0.15, 10.0, 70.0, seed + 200)](double time_s) {
      return inside(all, time_s);
    };
    run.mirror.stamp_off_us = [late, early](double time_s) {
      return 13'333.0 * (static_cast<double>(inside(late, time_s)) - inside(early, time_s));
    };
    run.until(80.0);
    EXPECT_EQ(run.clock.counts().stalls, 0) << "seed " << seed;
  }
}

// Calibration runs the motor at two speeds.
TEST(MirrorNewSpeed, EndsTheLockAtOnceUntilArmsConfirm) {
  for (const double factor : {0.5, 0.7, 0.95, 1.05, 1.5, 3.0}) {
    MirrorRun run = run_in_room(true);
    run.until(30.0);
    // So that the angle and the edge's time go on without a jump.
    const double slower_s = 2.0 * factor;
    const std::int64_t turns = 15;
    run.origin_us += std::llround(1e6 * static_cast<double>(turns) * (2.0 - slower_s));
    run.mirror.revolution_s = slower_s;
    run.edge = turns * 400;
    const double begin_s = run.line_s = static_cast<double>(turns) * slower_s;
    double ended_s = 1e9, known_s = 1e9;
    int wrong = 0;
    run.until(begin_s + 5.0 * slower_s, [&](double time_s, const MirrorState& state) {
      const double since_s = time_s - begin_s;
      if (!state.angle_known && ended_s > 1e8) {
        ended_s = since_s;
        EXPECT_EQ(state.state, State::kSearching);
        EXPECT_TRUE(state.reason.starts_with("the motor's speed has changed")) << state.reason;
      }
      if (state.angle_known && ended_s < 1e8) {
        known_s = std::min(known_s, since_s);
        wrong += std::abs(run.error_rad(time_s, state)) > 4.0 * kDeg;
      }
    });
    std::printf("period times %.2f: lock ended after %.3f s, known again after %.2f s\n", factor,
                ended_s, known_s);
    EXPECT_LT(ended_s, factor < 2.0 ? 0.2 : 0.6) << factor;
    EXPECT_LT(known_s, 1.6 * slower_s) << factor;
    EXPECT_EQ(wrong, 0) << factor;
    EXPECT_EQ(run.clock.counts().stalls, 0) << factor;
  }
}

}  // namespace
}  // namespace voxlist::scanner
