#pragma once

#include <optional>
#include <vector>

#include "tests/bench/drives/kinds.h"
#include "voxlist/geometry/pose.h"

namespace voxlist::bench {

/// One scan of a drive.
struct ScannedStep {
  Cloud scan;
  Pose2 truth;  ///< T_world_base; the world is floor_16_13() of the seed
  std::optional<Pose2> T_odom_base;
  bool bad = false;
  bool carried = false;  ///< just before this scan
};

/// Drive number `i` in the world of a seed. Equal arguments give equal bits.
std::vector<ScannedStep> scanned_drive(const DriveSpec& spec, int seed, int i);

}  // namespace voxlist::bench
