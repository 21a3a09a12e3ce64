#pragma once

#include "voxlist/planning/grids/floor_columns.h"
#include "voxlist/voxels/occupancy_map.h"

namespace voxlist::planning::test {

/// Corners of a box in voxels of 0.02 m, the last ones not included. A column is 4 voxels wide.
struct VoxelRange {
  Voxel low, high;
};

/// A map drawn by hand: what was hit, voxel by voxel, and what is free, cell by cell.
struct DrawnMap {
  OccupancyMap map;
  OccupancyMap free;

  void hit(const VoxelRange& range) {
    for_each(range, [&](const Voxel& v) { map.occupied.insert(v); });
  }

  /// Cells of 0.08 m.
  void pass(const VoxelRange& cells) {
    for_each(cells, [&](const Voxel& v) { free.passed.insert(v); });
  }

  /// A floor whose upper side is at a layer, below free cells up to 2.4 m, over cells from `low` to
  /// below `high`.
  void floor(const Cell& low, const Cell& high, std::int32_t layer = 0) {
    hit({{4 * low.x, 4 * low.y, layer - 1}, {4 * high.x, 4 * high.y, layer + 1}});
    const std::int32_t cell = floor_div(layer + 1, kLayersInCell);
    pass({{low.x, low.y, cell}, {high.x, high.y, cell + 30}});
  }

  FloorColumns columns() const {
    FloorColumns columns;
    columns.take(map, free);
    return columns;
  }

 private:
  template <class Visit>
  static void for_each(const VoxelRange& range, const Visit& visit) {
    for (std::int32_t z = range.low.z; z < range.high.z; ++z)
      for (std::int32_t y = range.low.y; y < range.high.y; ++y)
        for (std::int32_t x = range.low.x; x < range.high.x; ++x) visit({x, y, z});
  }
};

}  // namespace voxlist::planning::test
