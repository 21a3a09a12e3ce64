#pragma once

#include <cstdint>
#include <functional>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include "voxlist/geometry/laser_line.h"
#include "voxlist/scanner/mirror/mirror_clock.h"

namespace voxlist::scanner {

inline constexpr double kDeg = std::numbers::pi / 180.0;

/// A laser under a turning mirror with two arms, in a room, and the stepper's clock: written anew
/// for these tests, with nothing of what it tests.
struct SyntheticMirror {
  struct Arm {
    double angle_deg, first_deg, last_deg;
    bool there = true;
  };

  double revolution_s = 2.0;
  double line_hz = 75.03;
  bool staircase = false;
  double direction = 1.0;
  double stamp_jitter_us = 300.0, edge_jitter_us = 200.0;
  int steps_per_revolution = 400;
  double start_rad = 0.3;
  std::vector<Arm> arms = {{90.0, 25.0, 60.0}, {265.0, 120.0, 155.0}};
  double half_width_deg = 5.74;
  bool room = false;       ///< ranges of a room's walls; else everything is 3 m away
  bool sky = false;        ///< nothing above
  double speed_mps = 0.0;  ///< of the robot
  double turn_degps = 0.0;
  double dazzled = 0.0;  ///< share of beams without a measurement
  double lost_lines = 0.0, spurious = 0.0;
  double lost_edges = 0.0, doubled_edges = 0.0;
  std::function<double(double)> standing_s;    ///< for how long the mirror has stood until a time
  std::function<bool(double)> line_lost;       ///< lines that never come
  std::function<double(double)> stamp_off_us;  ///< by how much a line's time stamp is wrong

  double clock_period_s() const { return revolution_s / steps_per_revolution; }

  /// True mirror angle, not wrapped.
  double angle_rad(double time_s) const;

  /// The line that begins at a time; its time stamp without jitter.
  LaserLine line(double time_s);

  double range_m(double time_s, double beam_rad);

  std::mt19937 random{1};
};

/// Runs a clock over synthetic data.
struct MirrorRun {
  MirrorRun(const SyntheticMirror& of, const MirrorClockConfig& with)
      : mirror(of), config(with), clock(with) {}

  static MirrorClockConfig usual_config();

  /// Until `end_s`; calls `see(time_s, state)` after each line.
  void until(double end_s, const std::function<void(double, const MirrorState&)>& see = {});

  /// Estimated minus true angle at a time, by a state.
  double error_rad(double time_s, const MirrorState& state) const;

  SyntheticMirror mirror;
  MirrorClockConfig config;
  MirrorClock clock;
  std::int64_t origin_us = 1'700'000'000'000'000;
  bool clock_runs = true;
  double line_s = 0.0;
  std::int64_t edge = 0;
};

}  // namespace voxlist::scanner
