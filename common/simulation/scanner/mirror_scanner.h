#pragma once

#include <cstdint>
#include <vector>

#include "voxlist/geometry/cloud.h"
#include "voxlist/geometry/laser_line.h"
#include "voxlist/simulation/scanner/stepper_motor.h"
#include "voxlist/simulation/scanner/turning_mirror.h"
#include "voxlist/simulation/world/trajectory.h"
#include "voxlist/simulation/world/world.h"

namespace voxlist::simulation {

/// A 2D laser (SICK LMS 200) that looks up at a turning two-sided mirror, which throws its fan all
/// round, on a robot. The scanner's frame has the laser's axes and its origin at the middle of the
/// mirror's axis; in base it is at (0, 0, mount_height_m), not tilted.
struct MirrorScannerConfig {
  TurningMirrorConfig mirror;
  StepperMotorConfig motor;
  double mount_height_m = 0.6;
  std::vector<Box> body = robot_body();  ///< what the robot itself puts in the way, in base

  double turns_per_second = 75.03;  ///< of the laser's own mirror
  double range_max_m = 8.183;       ///< beyond it nothing is reported
  double range_sd_m = 0.005;
  double latency_s = 0.0;  ///< lines' time stamps are late by this

  /// The laser's housing and the robot's deck.
  static std::vector<Box> robot_body();
};

/// What became of one beam.
struct SimulatedBeam {
  enum class Met { kNothing, kArm, kEdge, kBody, kWorld };

  Met met = Met::kNothing;
  bool reflected = false;  ///< by the mirror; else it went straight from the laser
  double range_m = 0.0;    ///< true way from the optical centre; +infinity when it met nothing
  double path_m = 0.0;     ///< the part of it up to the mirror, 0 when it was not reflected
  Eigen::Vector3d origin_base =
      Eigen::Vector3d::Zero();  ///< where it left the mirror, or the laser
  Eigen::Vector3d direction_base = Eigen::Vector3d::Zero();  ///< from there, unit

  /// Where a range says that the beam ended, in base when it left.
  Eigen::Vector3d point_base(double measured_m) const {
    return origin_base + (measured_m - path_m) * direction_base;
  }
};

/// The scanner in a world, on a robot that moves: beams are traced from the optical centre by way
/// of arms, plate and the robot's body to the world, each at its own time. Const: use it from any
/// thread. World and trajectory must outlive it.
class MirrorScanner {
 public:
  MirrorScanner(const World& world, const Trajectory& truth, const MirrorScannerConfig& config,
                std::uint64_t seed);

  /// The beam that leaves at angle `beam_rad` and time `t_s`, with the shaft at psi.
  SimulatedBeam trace(double t_s, double beam_rad, double psi_rad) const;

  /// The same with the shaft where its motor has turned it.
  SimulatedBeam trace(double t_s, double beam_rad) const;

  /// What the laser measures in the half turn that begins at a time: beams 1 deg apart, from
  /// `first_angle_rad` up to 180 deg, with noise, in whole millimetres. The noise depends on the
  /// seed, the time, and nothing else.
  LaserLine measure(std::int64_t utime_us, double first_angle_rad = 0.0) const;

  const StepperMotor& motor() const { return motor_; }
  const MirrorScannerConfig& config() const { return config_; }

 private:
  const World& world_;
  const Trajectory& truth_;
  const MirrorScannerConfig config_;
  const TurningMirror mirror_;
  const StepperMotor motor_;
  const std::uint64_t seed_;
};

}  // namespace voxlist::simulation
