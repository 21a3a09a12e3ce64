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

std::vector<DrivenCell> GridBuilder::driven_from_origin() const {
  std::vector<DrivenCell> driven = driven_cells({Eigen::Vector3d::Zero()});
  const std::vector<DrivenCell> along = driven_cells(way_);
  driven.insert(driven.end(), along.begin(), along.end());
  std::vector<Eigen::Vector3d> way = way_;
  if (way.empty()) way.push_back(Eigen::Vector3d::Zero());
  const float floor_m = floor_under_base_m(columns_, way);
  for (DrivenCell& cell : driven) cell.height_m += floor_m;
  return driven;
}

std::vector<TypedGrid> GridBuilder::grids() const {
  std::vector<TypedGrid> grids;
  if (cells() == 0 || cells() > kMostCells) return grids;
  const std::vector<DrivenCell> driven = driven_from_origin();
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
