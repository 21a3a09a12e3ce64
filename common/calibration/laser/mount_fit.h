#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "voxlist/geometry/cloud.h"

namespace voxlist::calibration {

/// A drive, told twice.
struct LaserDrive {
  /// T_map_assumed: where scans by themselves place the frame that base would be if the laser's
  /// mount were as it is assumed to be; by the clouds' times, in the order of time.
  std::vector<StampedPose2> scans;

  /// T_odom_base, in the order of time.
  std::vector<StampedPose2> odometry;
};

/// What is wrong with the assumed mount, in this order. Metres, radians, seconds.
enum MountParameter {
  kMountX,
  kMountY,
  kMountYaw,
  kMountLatency,  ///< the clouds' times are late by this against odometry's
  kMountParameters
};
using MountVector = Eigen::Matrix<double, kMountParameters, 1>;

/// What a drive says of the mount.
struct MountFit {
  /// T_base_assumed, and the latency.
  MountVector correction = MountVector::Zero();

  /// Standard deviations. What the drive does not tell has a large one.
  MountVector sd = MountVector::Zero();

  /// Ways of two seconds that were compared, and by how much they disagree: 1 is what good wheels
  /// and scans differ by.
  std::size_t motions = 0;
  double disagreement = 0.0;
};

/// Compares ways over two seconds and turns over half a second, as scans and as odometry tell them,
/// whatever the yaw. What wheels are off by in all of the drive (their scale, their scale in turns,
/// a pull to one side) is fitted, too. Nothing where fewer than ten ways can be compared.
std::optional<MountFit> fit_mount(const LaserDrive& drive);

}  // namespace voxlist::calibration
