#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "voxlist/geometry/cloud.h"
#include "voxlist/geometry/pose.h"
#include "voxlist/simulation/building/floor_plan.h"
#include "voxlist/simulation/world/people.h"

namespace voxlist::bench {

/// What a ray met: a thing that stands there on both days (thin ones are poles, signs and a mesh),
/// one that stands there on one of them alone (moved furniture, a door), or somebody.
enum class Met : std::uint8_t { kStatic, kThin, kMoved, kPerson };

/// What scans: the paper's mirror scanner (5000 points), or a laser of 16 or 64 rings.
enum class GhostLaser { kMirror, k16Rings, k64Rings };

struct GhostScan {
  Cloud cloud;
  Pose2 truth;
  std::vector<Met> met;  ///< by each point
  /// Where rays of the second day would have met what was moved, had it not been (in base).
  std::vector<Eigen::Vector3f> missed;
  int lap = 0;  ///< 0 on the first day, 1 and 2 on the second
};

/// A robot's laps through a floor of four rooms: one on the first day and two on the second, when
/// furniture and doors were moved. People walk about all the time; others stand somewhere for a lap
/// of two minutes, each lap elsewhere, but for the last lap. Poles, signs and a mesh stand there on
/// both days.
struct GhostDriveConfig {
  GhostLaser laser = GhostLaser::kMirror;
  int seed = 1;
  int walking = 4, standing = 2;
};

/// A robot's way through all rooms and back to its start, at 0.5 m/s.
simulation::Trajectory lap(const simulation::Building& building);

/// Equal arguments give equal bits.
std::vector<GhostScan> ghost_drive(const GhostDriveConfig& config);

/// A lap on the day after, when furniture and doors were moved once more; people walk about.
std::vector<GhostScan> next_day(const GhostDriveConfig& config);

/// Boxes about what stood there on the first day and not on the second, as a person would erase it.
std::vector<Eigen::AlignedBox3d> moved_away(const GhostDriveConfig& config);

}  // namespace voxlist::bench
