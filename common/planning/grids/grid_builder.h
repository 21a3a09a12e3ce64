#pragma once

#include <Eigen/Core>
#include <vector>

#include "voxlist/planning/grids/typed_grid.h"

namespace voxlist::planning {

/// Most cells of a grid: 512 m x 512 m. A map that spans more is a job for `voxlist export --tiles`
/// of its parts.
inline constexpr std::size_t kMostCells = std::size_t{6400} * 6400;

/// Makes the floor plans of several robots of one map, and follows it: columns where the map has
/// changed are made again, then the floor is flooded and typed as a whole, which takes some 0.1 us
/// a cell and robot. The same map and way give the same grids.
class GridBuilder {
 public:
  explicit GridBuilder(std::vector<RobotProfile> robots) : robots_(std::move(robots)) {}

  /// Takes a map and its free space as they are now.
  void take(const OccupancyMap& map, const OccupancyMap& free_space);

  /// Follows blocks of them that changed since.
  void follow(const OccupancyMap& map, const ChangedBlocks& changed, const OccupancyMap& free_space,
              const ChangedBlocks& changed_free);

  /// The way that a robot has driven: positions of base in the map, in the place of those before.
  /// The map's origin, where its first cloud was taken, is always one of them.
  void drive(std::vector<Eigen::Vector3d> way) { way_ = std::move(way); }

  const std::vector<RobotProfile>& robots() const { return robots_; }
  const FloorColumns& columns() const { return columns_; }

  /// How many cells a grid has; 0 without a map.
  std::size_t cells() const { return columns_.bounds() ? columns_.bounds()->size() : 0; }

  /// A grid for each robot, in their order; none without a map, or above kMostCells.
  std::vector<TypedGrid> grids() const;

 private:
  std::vector<DrivenCell> driven_from_origin() const;

  std::vector<RobotProfile> robots_;
  FloorColumns columns_;
  std::vector<Eigen::Vector3d> way_;
};

}  // namespace voxlist::planning
