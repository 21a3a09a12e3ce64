#include "voxlist/planning/grids/grid_builder.h"

#include <algorithm>

#include "voxlist/planning/grids/cell_array.h"

namespace voxlist::planning {
namespace {

void take_in(std::optional<CellBox>& box, const CellBox& more) {
  take_in(box, more.low);
  take_in(box, more.high - Cell{1, 1});
}

// Puts a part of a grid in its place. True: it differs from what was there.
bool put(const TypedGrid& part, TypedGrid& grid) {
  if (relaid(grid.box, grid.cells, part.box, CellType::kUnknown) == part.cells) return false;
  copy_cells(part.box, part.cells, grid.box, grid.cells);
  return true;
}

}  // namespace

GridBuilder::GridBuilder(std::vector<RobotProfile> robots) : robots_(std::move(robots)) {
  for (const RobotProfile& robot : robots_)
    if (std::ranges::find(floods_, robot.step_m, &Flood::step_m) == floods_.end())
      floods_.emplace_back(robot.step_m);
}

void GridBuilder::take(const OccupancyMap& map, const OccupancyMap& free_space) {
  columns_.take(map, free_space);
  changes_.clear();
  grids_.clear();
  driven_ = {};
  for (Flood& flood : floods_) flood = Flood(flood.step_m());
}

void GridBuilder::follow(const OccupancyMap& map, const ChangedBlocks& changed,
                         const OccupancyMap& free_space, const ChangedBlocks& changed_free) {
  const auto more = columns_.follow(map, changed, free_space, changed_free);
  changes_.insert(changes_.end(), more.begin(), more.end());
}

void GridBuilder::set_floor() {
  std::vector<Eigen::Vector3d> way;
  for (const auto& part : ways_) way.insert(way.end(), part.begin(), part.end());
  if (way.empty()) way.push_back(Eigen::Vector3d::Zero());
  if (!driven_.drive(ways_))
    for (Flood& flood : floods_) flood = Flood(flood.step_m());
  driven_.set_floor_m(floor_under_base_m(columns_, way));
}

// Where what lies under the robots has changed: columns, or the floor.
std::optional<CellBox> GridBuilder::follow_floods() {
  const std::vector<TileChange> changes = std::exchange(changes_, {});
  const std::vector<Cell> driven = driven_.take_changes();
  std::optional<CellBox> changed;
  for (const TileChange& tile : changes)
    take_in(changed, {tile.low, tile.low + Cell{kTileEdge, kTileEdge}});
  for (Flood& flood : floods_)
    if (const auto more = flood.follow(columns_, changes, driven_, driven)) take_in(changed, *more);
  return changed;
}

void GridBuilder::type(const CellBox& changed, std::optional<CellBox>& retyped) {
  for (const Flood& flood : floods_) {
    std::int32_t margin = 0;
    for (const RobotProfile& robot : robots_)
      if (robot.step_m == flood.step_m()) margin = std::max(margin, typing_margin(robot));
    const CellBox box = common_part(grown(changed, kGroundMargin + margin), *columns_.bounds());
    const Ground ground(columns_, flood, grown(box, margin));
    for (std::size_t i = 0; i < robots_.size(); ++i)
      if (robots_[i].step_m == flood.step_m() &&
          put(type_cells(columns_, ground, robots_[i], box), grids_[i]))
        take_in(retyped, box);
  }
}

std::optional<CellBox> GridBuilder::update() {
  if (cells() == 0 || cells() > kMostCells) {
    grids_.clear();
    changes_.clear();
    return std::nullopt;
  }
  set_floor();
  const CellBox& box = *columns_.bounds();
  const bool has_grown = grids_.empty() || grids_.front().box != box;
  grids_.resize(robots_.size());
  for (TypedGrid& grid : grids_)
    if (has_grown) grid = {box, relaid(grid.box, grid.cells, box, CellType::kUnknown)};
  if (has_grown) driven_.change_all();
  std::optional<CellBox> retyped;
  if (const auto changed = follow_floods()) type(*changed, retyped);
  return has_grown ? box : retyped;
}

std::size_t GridBuilder::memory_bytes() const {
  std::size_t bytes = columns_.memory_bytes();
  for (const Flood& flood : floods_) bytes += flood.memory_bytes();
  for (const TypedGrid& grid : grids_) bytes += grid.cells.capacity();
  return bytes;
}

}  // namespace voxlist::planning
