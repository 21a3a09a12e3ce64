#pragma once

#include <cstdint>
#include <optional>
#include <variant>

#include "geometry/cloud.h"
#include "simulation/building.h"
#include "simulation/mirror_scanner.h"
#include "simulation/robot.h"
#include "simulation/tour.h"
#include "simulation/trajectory.h"

namespace voxlist {

/// A whole simulated run. Equal configs give equal bits.
struct SimulationConfig {
  int seed = 1;
  double duration_s = 0.0;
  bool perfect_deskew = false;
  BuildingConfig building;
  TourConfig tour;
  DriveConfig drive;
  OdometryConfig odometry;
  MirrorScannerConfig scanner;

  /// What a settings file may choose; the rest is for tests.
  template <class Visitor>
  void visit(Visitor& v) {
    v("seed", seed, "of the errors of wheels and laser", 0, 1'000'000'000);
    v("duration_s", duration_s, "0: until the tour is back at its start", 0.0, 86'400.0);
    v("perfect_deskew", perfect_deskew,
      "sweeps are put together by the true motion, not by what the wheels measured");
    v("building_seed", building.seed, "of the building", 0, 1'000'000'000);
    v("rooms", building.rooms, "left and right of the corridor", 0, 100);
    v("length_m", building.length_m, "of the building, along the corridor", 5.0, 500.0);
    v("depth_m", building.depth_m, "of the building, across the corridor", 5.0, 100.0);
    v("range_max_m", scanner.range_max_m, "of the laser", 1.0, 100.0);
    v("range_sd_m", scanner.range_sd_m, "noise of the laser", 0.0, 1.0);
  }
};

/// What the wheels measured: T_odom_base.
struct SimulatedOdometry {
  StampedPose2 measured;
};

/// Where the robot truly is: T_map_base, the identity at the start.
struct SimulatedTruth {
  StampedPose2 pose;
};

/// Odometry, truth, or one sweep in base. Times are from the run's start.
using SimulatedEvent = std::variant<SimulatedOdometry, SimulatedTruth, Cloud>;

/// A robot that drives through a building and back to its start, as events in the order of their
/// times: odometry at its rate, and at the end of each sweep the truth and the cloud, after the
/// odometry of the same time. Past the tour's end the robot stands still.
class SimulatedRun {
 public:
  /// Throws as make_building and plan_tour do.
  explicit SimulatedRun(const SimulationConfig& config);

  /// The next event; none after the last.
  std::optional<SimulatedEvent> next();

  const Building& building() const { return building_; }
  const Trajectory& truth() const { return truth_; }
  const Trajectory& odometry() const { return odometry_; }
  double duration_s() const { return duration_s_; }

 private:
  const SimulationConfig config_;
  const Building building_;
  const Trajectory truth_, odometry_;
  const double duration_s_;
  std::int64_t samples_ = 0;  // of odometry, told so far
  std::int64_t sweeps_ = 0;
  bool truth_told_ = false;  // of the sweep that is next
};

}  // namespace voxlist
