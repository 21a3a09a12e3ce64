#pragma once

#include <cstdint>
#include <optional>
#include <variant>

#include "voxlist/geometry/cloud.h"
#include "voxlist/geometry/laser_line.h"
#include "voxlist/simulation/run/simulation_config.h"
#include "voxlist/simulation/world/trajectory.h"
#include "voxlist/simulation/world/world.h"

namespace voxlist::simulation {

/// What the wheels measured: T_odom_base.
struct SimulatedOdometry {
  StampedPose2 measured;
};

/// Where the robot truly is: T_map_base. A tour starts at the identity.
struct SimulatedTruth {
  StampedPose2 pose;
};

/// The clock moves the mirror's motor on by a step.
struct SimulatedClockEdge {
  std::int64_t utime_us;
};

/// Times are from the run's start. A line's is its stamp, a cloud's the sweep's end.
using SimulatedEvent =
    std::variant<SimulatedOdometry, SimulatedTruth, SimulatedClockEdge, LaserLine, Cloud>;

/// A robot that drives through a building and back to its start, or stands in a room, as events in
/// the order of their times. With clouds: odometry at its rate, and at the end of each sweep the
/// truth and the cloud. Without: odometry and truth at odometry's rate, with lines also the clock's
/// edges and the lines. Of the same time odometry comes first, then the truth. Past the tour's end
/// the robot stands still.
class SimulatedRun {
 public:
  /// Throws as make_building, plan_tour and StepperMotor do, and std::invalid_argument for a room
  /// that is not there.
  explicit SimulatedRun(const SimulationConfig& config);
  SimulatedRun(const SimulatedRun&) = delete;
  SimulatedRun& operator=(const SimulatedRun&) = delete;

  /// The next event; none after the last.
  std::optional<SimulatedEvent> next();

  const Building& building() const { return world_.building(); }
  const World& world() const { return world_; }
  const Trajectory& truth() const { return truth_; }
  const Trajectory& odometry() const { return odometry_; }
  const MirrorScanner& scanner() const { return scanner_; }
  double duration_s() const { return duration_s_; }

 private:
  SimulatedRun(const SimulationConfig& config, const Building& building);

  SimulatedOdometry next_odometry();
  SimulatedTruth next_truth();
  SimulatedClockEdge next_edge();
  LaserLine next_line();
  Cloud next_cloud();
  double odometry_s() const;
  double truth_s() const;
  double edge_s() const;
  double line_s() const;
  double cloud_s() const;

  const SimulationConfig config_;
  const Trajectory truth_, odometry_;
  const double duration_s_;
  const World world_;
  const MirrorScanner scanner_;
  std::int64_t odometries_ = 0, truths_ = 0, edges_ = 0, lines_ = 0, clouds_ = 0;  // told so far
};

}  // namespace voxlist::simulation
