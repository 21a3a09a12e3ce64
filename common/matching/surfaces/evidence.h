#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>

#include "voxlist/geometry/pose.h"
#include "voxlist/matching/scan/match_points.h"
#include "voxlist/matching/surfaces/surfels.h"
#include "voxlist/voxels/bit_grid.h"
#include "voxlist/voxels/occupancy_map.h"

namespace voxlist::matching {

/// What a map says to a scan at a pose. Integers alone: the same bits everywhere.
struct Evidence {
  /// Ends of rays, each one of three: on something that the map knows (hits), in space that rays
  /// have passed (misses: people, moved furniture, or a wrong pose), anywhere else (unknown).
  int points = 0;
  int hits = 0;
  int misses = 0;
  int unknown = 0;
  /// Rays long enough to be looked at, and those that went through a thing of the map well before
  /// their end: gone furniture, or a wrong pose.
  int rays = 0;
  int violations = 0;

  bool operator==(const Evidence&) const = default;
};

/// How much evidence speaks for a pose, at most 1: the share of hits among the ends of rays of
/// which the map knows anything, less what rays went through. Unknown space hardly counts.
double support_of(const Evidence& evidence);

/// How near (m) a ray's end must be to the map's things. It forgives inexact poses and sparse maps,
/// and still tells what is gone or new: at 0.04 m, alike rooms would differ by chance where maps
/// are sparse. The coefficients of confidence.cpp were fitted with it.
inline constexpr double kReach_m = 0.08;

/// A map made ready for weighing poses. The map must outlive it. Reading from several threads is
/// safe.
class EvidenceMap {
 public:
  explicit EvidenceMap(const OccupancyMap& map);

  /// The owner calls this when blocks of the map have gained or lost voxels or passed cells.
  void map_changed(const ChangedBlocks& changed);

  /// What the map says to rays at a pose. A ray's end is on the map when a voxel is within about
  /// `reach_m` on each axis. About 0.2 ms for 600 rays of 4 m.
  Evidence at(const Pose2& T_map_base, std::span<const ScanRay> rays,
              double reach_m = kReach_m) const {
    return at(T_map_base, rays, reach_m, nullptr);
  }

  /// The same, where an end is also on the map when it lies within reach of the plane of a surfel:
  /// of a wall that few rays have met, the plane is known where voxels are not. So a scan whose
  /// rays meet the very spots of an earlier one has nothing more than one that meets others.
  Evidence on_surfaces(const Pose2& T_map_base, std::span<const ScanRay> rays,
                       const SurfelMap& surfels, double reach_m = kReach_m) const {
    return at(T_map_base, rays, reach_m, &surfels);
  }

 private:
  Evidence at(const Pose2& T_map_base, std::span<const ScanRay> rays, double reach_m,
              const SurfelMap* surfels) const;
  Voxel cell_of(const Voxel& block) const;
  const VoxelBlock* block_at(const Voxel& position) const;
  bool hit(const Eigen::Vector3d& end, std::int32_t reach) const;
  bool in_matter(const Voxel& voxel) const;
  bool violated(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;

  const OccupancyMap& map_;
  MapRevision revision_;  // of the map that filled_ was made of
  int shift_ = 0;
  /// Where the map has any blocks, 2^shift_ blocks a cell along each axis.
  BitGrid filled_;
};

}  // namespace voxlist::matching
