#pragma once

#include <string>

#include "voxlist/geometry/pose.h"
#include "voxlist/simulation/world/trajectory.h"

namespace voxlist::test {

/// What a laser of 16 rings recorded on a robot that drove through a simulated building at up to
/// 1 m/s and 60 deg/s: pitched down by 10 deg, turned by 30 deg, one revolution in 0.1 s.
class RawScanSet {
 public:
  static constexpr int kScans = 16;

  RawScanSet();

  /// scan_0.ply and so on, in the laser's frame, each point with its `time` in seconds after the
  /// scan's; poses.csv and odometry.csv.
  void write(const std::string& folder) const;

  /// The robot's settings: where the laser sits, on the channel LASER_3D.
  static std::string settings();

  /// T_map_base at a time of the data, where map is the building's.
  Pose2 truth(std::int64_t utime_us) const;

 private:
  simulation::Trajectory drive_;
};

}  // namespace voxlist::test
