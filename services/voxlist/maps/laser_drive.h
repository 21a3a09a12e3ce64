#pragma once

#include <cstddef>
#include <vector>

#include "services/voxlist/recording/recording.h"
#include "voxlist/calibration/laser/mount_fit.h"
#include "voxlist/geometry/tilt.h"
#include "voxlist/matching/localisation/localiser.h"

namespace voxlist::desk {

/// What a drive's scans say by themselves.
struct SeenDrive {
  std::size_t scans = 0;

  /// Of each scan that shows the floor: what would make it level (T_level_base).
  std::vector<Tilt> floors;

  /// Where the scans that could be placed are in a map of them alone; odometry as it was recorded.
  calibration::LaserDrive drive;
};

/// The floors of the first scans of a recording; the rest is not read.
SeenDrive see_floors(Recording& recording, std::size_t scans);

/// Maps a recording without its odometry.
SeenDrive see_drive(Recording& recording, const matching::LocaliserConfig& localiser);

}  // namespace voxlist::desk
