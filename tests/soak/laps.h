#pragma once

#include <cstdint>
#include <memory>

#include "voxlist/simulation/run/simulated_run.h"

namespace voxlist::soak {

/// A building that the robot drives through, and who walks in it.
struct LapsConfig {
  int rooms = 6;
  int people = 4;
  int building_seed = 1;
  int seed = 1;  ///< of the first lap's people and errors; each lap has the next
};

/// A robot with a mirror scanner that drives the tour through one building again and again, without
/// end: laser lines, odometry and truth, each lap with other people and other errors of wheels and
/// laser. Laps follow each other without a gap: at a lap's end robot and mirror are where they were
/// at its start, and odometry goes on from where it was. One lap is held at a time.
class Laps {
 public:
  explicit Laps(const LapsConfig& config);

  /// The next event; times in it are microseconds since the first lap's start. No clock edges.
  simulation::SimulatedEvent next();

  /// How many laps have ended.
  int done() const { return done_; }

  /// How long the robot stands at first (us): so long a mirror's angle needs to be well known.
  static constexpr std::int64_t kStand_us = 45'000'000;

 private:
  void begin_next_lap();

  LapsConfig config_;
  std::unique_ptr<simulation::SimulatedRun> run_;
  Pose2 T_odom_start_;         ///< odometry where the lap began
  std::int64_t start_us_ = 0;  ///< of the lap
  int done_ = 0;
};

}  // namespace voxlist::soak
