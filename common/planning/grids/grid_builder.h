#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "voxlist/planning/grids/typed_grid.h"

namespace voxlist::planning {

/// Most cells of a grid: 512 m x 512 m. A map that spans more is a job for `voxlist export --tiles`
/// of its parts.
inline constexpr std::size_t kMostCells = std::size_t{6400} * 6400;

/// Makes the floor plans of several robots of one map, and follows it: what has changed is made
/// again, and what hangs on it. The same map and way give the same grids, whether followed or taken
/// at once.
class GridBuilder {
 public:
  explicit GridBuilder(std::vector<RobotProfile> robots);

  /// Takes a map and its free space as they are now.
  void take(const OccupancyMap& map, const OccupancyMap& free_space);

  /// Follows blocks of them that changed since.
  void follow(const OccupancyMap& map, const ChangedBlocks& changed, const OccupancyMap& free_space,
              const ChangedBlocks& changed_free);

  /// The way that a robot has driven: positions of base in the map, in the place of those before;
  /// and parts of what was driven since, none of which goes on where another ends. The map's
  /// origin, where its first cloud was taken, is always one of them.
  void drive(std::vector<Eigen::Vector3d> way,
             std::vector<std::vector<Eigen::Vector3d>> since = {}) {
    ways_ = std::move(since);
    ways_.insert(ways_.begin(), std::move(way));
  }

  const std::vector<RobotProfile>& robots() const { return robots_; }
  const FloorColumns& columns() const { return columns_; }

  /// How many cells a grid has; 0 without a map.
  std::size_t cells() const { return columns_.bounds() ? columns_.bounds()->size() : 0; }

  /// Brings the grids up to date. Cells that have changed lie in the box that comes back: the whole
  /// one where the grids have another box than before. None: the grids are what they were.
  std::optional<CellBox> update();

  /// A grid for each robot, in their order, as of the last update(); none without a map, or above
  /// kMostCells.
  const std::vector<TypedGrid>& grids() const { return grids_; }

  std::size_t memory_bytes() const;

 private:
  void set_floor();
  std::optional<CellBox> follow_floods();
  void type(const CellBox& changed, std::optional<CellBox>& retyped);

  std::vector<RobotProfile> robots_;
  FloorColumns columns_;
  std::vector<TileChange> changes_;
  std::vector<std::vector<Eigen::Vector3d>> ways_;
  DrivenCells driven_;
  std::vector<Flood> floods_;  // one for each height of steps
  std::vector<TypedGrid> grids_;
};

}  // namespace voxlist::planning
