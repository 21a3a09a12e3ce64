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

/// A whole simulated run. One seed decides everything; equal configs give equal bits.
struct SimulationConfig {
  std::uint64_t seed = 1;       ///< of the wheels and the laser; the building has its own
  double duration_s = 0.0;      ///< 0: until the tour is back at its start
  bool perfect_deskew = false;  ///< sweeps are put together by the true motion, not the wheels'
  BuildingConfig building;
  TourConfig tour;
  DriveConfig drive;
  OdometryConfig odometry;
  MirrorScannerConfig scanner;
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
/// times: odometry and truth at the odometry's rate, a cloud at the end of each sweep, with
/// odometry and truth of the same time before it. Past the tour's end the robot stands still.
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
  std::int64_t sample_ = 0;  // of odometry
  std::int64_t sweep_ = 1;
  bool truth_is_due_ = false;
};

}  // namespace voxlist
