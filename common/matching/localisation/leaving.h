#pragma once

#include <cstdint>
#include <optional>

#include "voxlist/geometry/pose.h"
#include "voxlist/matching/localisation/localisation.h"

// When a robot has left a map: then another piece of map begins, and in this one it must be found
// anew.
namespace voxlist::matching {

/// When a scan was taken, and where wheels had it (T_odom_base), if there is odometry.
struct ScanMoment {
  std::int64_t utime_us = 0;
  std::optional<Pose2> T_odom_base;
};

/// Whether a scan that is not TRACKING fits where the robot is followed, and only what is in sight
/// does not hold it in some direction, along a street: the next scans will, or the whole belief
/// fades.
bool is_followed(const Localisation& found);

/// Whether a robot cannot be far from where its last scan was placed in a map: then it sees what
/// the map has there, and the next scan, or the one after, fits. Else it has left the map. `found`:
/// what the map says of the scan; where the robot is still followed, odometry knows how far it
/// went.
bool is_near(const ScanMoment& placed, const ScanMoment& now, const Localisation& found,
             double max_speed_mps);

}  // namespace voxlist::matching
