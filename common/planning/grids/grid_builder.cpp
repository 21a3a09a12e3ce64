#include "voxlist/planning/grids/grid_builder.h"

#include <optional>

namespace voxlist::planning {

void GridBuilder::take(const OccupancyMap& map, const OccupancyMap& free_space) {
  columns_.take(map, free_space);
}

void GridBuilder::follow(const OccupancyMap& map, const ChangedBlocks& changed,
                         const OccupancyMap& free_space, const ChangedBlocks& changed_free) {
  columns_.follow(map, changed, free_space, changed_free);
}

std::vector<TypedGrid> GridBuilder::grids() const {
  std::vector<TypedGrid> grids;
  if (cells() == 0 || cells() > kMostCells) return grids;
  std::vector<DrivenCell> driven = driven_cells({Eigen::Vector3d::Zero()});
  const std::vector<DrivenCell> along = driven_cells(way_);
  driven.insert(driven.end(), along.begin(), along.end());
  std::optional<Ground> ground;
  double step_m = 0.0;
  for (const RobotProfile& robot : robots_) {
    if (!ground || robot.step_m != step_m) ground.emplace(columns_, driven, robot.step_m);
    step_m = robot.step_m;
    grids.push_back(type_cells(columns_, *ground, robot));
  }
  return grids;
}

}  // namespace voxlist::planning
