#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "voxlist/geometry/cloud.h"
#include "voxlist/matching/search/pose_window.h"
#include "voxlist/simulation/world/world.h"
#include "voxlist/voxels/occupancy_map.h"

namespace voxlist::desk {

/// How much is measured.
struct ReportScale {
  int queries = 20;            ///< scans that are localised for each figure
  int wrong_poses = 2000;      ///< poses whose overlap is counted for each resolution
  int reliability_scans = 60;  ///< of each kind, in each building
  int buildings = 3;           ///< for the reliability of probabilities
  int mapped = 20;             ///< scans of the maps that compare resolutions
};

/// The same figures, of a few scans each: to see that all is there.
ReportScale quick_scale();

/// What the scans are of: rooms as large as the paper's (3 by 6 m, section V), four of them on 10 x
/// 9 m; or a floor of 16 x 12 m with six.
enum class Floor { kRooms, kLarger };

/// A scan, and where it was taken (T_map_base).
struct PlacedScan {
  Cloud cloud;
  Pose2 truth;
};

/// What the paper's experiments are repeated in: simulated, furnished rooms off a corridor, and the
/// paper's scanner. Equal seeds give equal bits.
class Scene {
 public:
  Scene(int seed, const ReportScale& scale, Floor floor = Floor::kRooms);

  int seed() const { return seed_; }
  const ReportScale& scale() const { return scale_; }
  const simulation::World& world() const { return world_; }

  /// 20 scans of a tour through all rooms, evenly spread; the first at the origin.
  const std::vector<PlacedScan>& tour() const { return tour_; }

  /// Scans of a robot that stands here and there, none of them in the map; as many as asked for.
  std::vector<PlacedScan> queries(int count) const;

  /// The 20 scans at their true poses.
  const OccupancyMap& map() const { return map_; }

  /// All poses on the floor.
  matching::PoseWindow everywhere() const;

 private:
  const int seed_;
  const Floor floor_;
  const ReportScale scale_;
  const simulation::World world_;
  const std::vector<PlacedScan> tour_;
  OccupancyMap map_;
};

/// A building as that of a scene: `changed`: furniture is moved, gone, new.
simulation::Building building_of(int seed, Floor floor, bool changed = false);

/// A pose that leaves the robot room, in such a building.
Pose2 free_pose(const simulation::Building& building, Floor floor, std::uint64_t seed,
                std::uint64_t number);

/// What a robot that stands there sees, with so many people about it.
Cloud standing_scan(const simulation::Building& building, const Pose2& pose, int people,
                    std::uint64_t seed);

}  // namespace voxlist::desk
