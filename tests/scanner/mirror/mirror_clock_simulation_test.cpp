// The mirror clock on the simulator's scanner, in its building: physics that knows nothing of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <random>
#include <set>
#include <string>

#include "tests/scanner/mirror/synthetic_mirror.h"
#include "voxlist/geometry/pose.h"
#include "voxlist/scanner/mirror/mirror_clock.h"
#include "voxlist/simulation/scanner/mirror_scanner.h"
#include "voxlist/simulation/world/robot.h"
#include "voxlist/simulation/world/tour.h"

namespace voxlist::scanner {
namespace {

using State = MirrorState::State;

simulation::Trajectory circle(double speed_mps, double turn_degps, double duration_s) {
  const double turn_radps = turn_degps * kDeg, radius_m = speed_mps / turn_radps;
  std::vector<Pose2> poses;
  for (double t = 0.0; t < duration_s; t += 0.02)
    poses.push_back({2.0 + radius_m * std::sin(turn_radps * t),
                     0.4 - radius_m * std::cos(turn_radps * t), wrap_angle(turn_radps * t)});
  return {0.02, std::move(poses)};
}

struct SimulatedMirror {
  SimulatedMirror(const simulation::MirrorScannerConfig& scanner_config,
                  simulation::Trajectory trajectory)
      : truth(std::move(trajectory)), scanner(world, truth, scanner_config, 1) {}

  // Calls see(time_s, state, error_deg) after each line.
  template <class See>
  void run(double end_s, const See& see) {
    std::normal_distribution<double> jitter(0.0, 1.0);
    std::int64_t edge = 0;
    for (double t = 0.1; t < end_s; t += 1.0 / scanner.config().turns_per_second) {
      for (; scanner.motor().edge_s(edge) < t; ++edge) {
        const double edge_s = scanner.motor().edge_s(edge);
        if (scanner.motor().clock_seen(edge_s))
          clock.add_edge(kOrigin_us + std::llround(edge_s * 1e6 + 200.0 * jitter(random)));
      }
      if (hole && hole(t)) continue;
      LaserLine line = scanner.measure(std::llround(t * 1e6));
      line.utime_us = kOrigin_us + std::llround(t * 1e6 + 300.0 * jitter(random));
      const MirrorState state = clock.add_line(line);
      const double state_s = static_cast<double>(state.utime_us - kOrigin_us) * 1e-6;
      see(t, state, wrap_angle(state.angle_rad - scanner.motor().angle_rad(state_s)) / kDeg);
    }
  }

  static constexpr std::int64_t kOrigin_us = 1'700'000'000'000'000;
  simulation::World world{simulation::make_building({})};
  simulation::Trajectory truth;
  simulation::MirrorScanner scanner;
  MirrorClock clock{MirrorRun::usual_config()};
  std::mt19937 random{2};
  std::function<bool(double)> hole;  // no line comes then
};

TEST(MirrorClockInSimulation, KnowsTheAngleAndRaisesNoAlarmOnATourOfTheBuilding) {
  const simulation::Trajectory tour =
      simulation::drive(simulation::plan_tour(simulation::make_building({}), {}), {});
  SimulatedMirror mirror({}, tour);
  double sum = 0.0;
  int lines = 0;
  std::set<std::string> reasons;
  mirror.run(tour.duration_s(), [&](double time_s, const MirrorState& state, double error_deg) {
    if (time_s > 5.0 && !state.reason.empty()) reasons.insert(state.reason);
    if (time_s < 40.0) return;
    sum += error_deg * error_deg;
    ++lines;
  });
  std::printf("simulated scanner on a tour of %.0f s: RMS %.4f deg\n", tour.duration_s(),
              std::sqrt(sum / lines));
  EXPECT_GT(lines, 5'000);
  EXPECT_LE(std::sqrt(sum / lines), 0.05);
  EXPECT_TRUE(reasons.empty()) << *reasons.begin();
}

// Each 1.3 s half a second of lines is lost, so that each part of the mirror's turn is, and many
// passages of the arms.
TEST(MirrorClockInSimulation, TakesLostLinesForNoStallOnATourOfTheBuilding) {
  const simulation::Trajectory tour =
      simulation::drive(simulation::plan_tour(simulation::make_building({}), {}), {});
  SimulatedMirror mirror({}, tour);
  mirror.hole = [](double time_s) { return time_s > 10.0 && std::fmod(time_s, 1.3) < 0.5; };
  mirror.run(tour.duration_s(), [](double, const MirrorState&, double) {});
  EXPECT_EQ(mirror.clock.counts().stalls, 0);
}

TEST(MirrorClockInSimulation, ReportsAStallWithinHalfASecond) {
  double worst_s = 0.0;
  for (const double stall_s : {20.0, 20.15, 20.3, 20.5, 20.75, 20.9, 21.2, 21.6}) {
    for (const bool drives : {false, true}) {
      simulation::MirrorScannerConfig config;
      config.motor.faults = {{.from_s = stall_s, .to_s = stall_s + 3.0, .gain = 0.0}};
      SimulatedMirror mirror(config, drives ? circle(0.5, 45.0, 30.0)
                                            : simulation::Trajectory(0.02, {{2.0, 0.0, 0.7}}));
      double told_s = 1e9;
      int early = 0;
      mirror.run(stall_s + 2.0, [&](double time_s, const MirrorState& state, double) {
        if (state.state != State::kStalled) return;
        if (time_s < stall_s) ++early;
        told_s = std::min(told_s, time_s - stall_s);
      });
      EXPECT_EQ(early, 0) << stall_s << drives;
      EXPECT_LE(told_s, 0.5) << stall_s << drives;
      worst_s = std::max(worst_s, told_s);
      std::printf("stall at %.2f %s: told after %.3f s\n", stall_s, drives ? "driving" : "standing",
                  told_s);
    }
  }
  std::printf("simulated scanner, stalls: told after %.3f s at the latest\n", worst_s);
}

}  // namespace
}  // namespace voxlist::scanner
