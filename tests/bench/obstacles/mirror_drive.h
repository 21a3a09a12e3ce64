#pragma once

#include <cstdint>
#include <optional>

#include "tests/bench/ramps/slab_world.h"
#include "voxlist/geometry/cloud.h"
#include "voxlist/simulation/scanner/turning_mirror.h"

namespace voxlist::bench {

/// How a robot drives and what it carries.
struct MirrorDriveConfig {
  double start_x_m = -6.0;
  double y_m = 0.0;
  double heading_rad = 0.0;
  double speed_mps = 0.5;
  double scanner_height_m = 0.8;
  double sweep_s = 1.0;         ///< the beam once round
  double range_sd_m = 0.01;     ///< of each range
  double rocking_rad = 0.0035;  ///< the robot rolls and pitches so far, about once a second
  std::uint64_t seed = 1;
};

/// A robot that drives straight on over a world that may slope, under the mirror scanner: slices of
/// five lines, as cloud_assembler makes them, and odometry that is up to 1 % off and flat.
class MirrorDrive {
 public:
  MirrorDrive(const SlabWorld& world, const MirrorDriveConfig& config);

  /// Where the robot is: its wheels on the ground.
  Pose3 truth(double t_s) const;

  Pose2 T_odom_base(double t_s) const;

  /// The slice that ends at a time, in base then.
  Cloud slice(double t_end_s) const;

  static constexpr double kSlice_s = 5.0 / 75.0;

 private:
  Pose2 planar(double t_s) const;
  std::optional<double> range_m(double t_s, const Eigen::Vector3d& origin,
                                const Eigen::Vector3d& direction) const;
  void add_beam(double t_s, double t_end_s, double beam_rad, double noise_m, Cloud& cloud) const;

  const SlabWorld& world_;
  const MirrorDriveConfig config_;
  const simulation::TurningMirror mirror_;
  double scale_, start_rad_, rocking_phase_rad_;
};

}  // namespace voxlist::bench
