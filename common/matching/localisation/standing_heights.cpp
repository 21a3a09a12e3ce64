#include "voxlist/matching/localisation/standing_heights.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>

namespace voxlist::matching {
namespace {

// Rays went this far (cells of 0.08 m) above a surface on which a robot stands: 0.16 m, 0.4 m.
constexpr std::int32_t kFreeAbove[] = {2, 5};
// Surfaces whose heights differ by no more (cells) are one floor: a search finds what is lifted by
// 0.2 m.
constexpr std::int32_t kOneFloor = 2;
// A floor is no smaller than this (m^2): a robot turns on it.
constexpr double kLeast_m2 = 1.0;
constexpr std::size_t kMost = 16;

struct Level {
  double cells = 0.0, sum_m = 0.0;
};

// Cells whose surface has free space above, and their heights.
std::map<std::int32_t, Level> levels_of(const OccupancyMap& map) {
  const auto ratio = static_cast<std::int32_t>(
      std::lround(map.passed.resolution_m() / map.occupied.resolution_m()));
  const auto cell_of = [&](std::int32_t v) { return (v - (v < 0 ? ratio - 1 : 0)) / ratio; };
  VoxelMap seen(map.passed.resolution_m());
  std::map<std::int32_t, Level> levels;
  map.occupied.for_each_voxel([&](const Voxel& voxel) {
    const Voxel cell{cell_of(voxel.x), cell_of(voxel.y), cell_of(voxel.z)};
    const bool is_free = std::all_of(std::begin(kFreeAbove), std::end(kFreeAbove), [&](auto up) {
      return map.passed.contains({cell.x, cell.y, cell.z + up});
    });
    if (!is_free || !seen.insert(cell)) return;
    Level& level = levels[cell.z];
    level.cells += 1.0;
    level.sum_m += (voxel.z + 0.5) * map.occupied.resolution_m();
  });
  return levels;
}

}  // namespace

std::vector<double> standing_heights(const OccupancyMap& map) {
  std::map<std::int32_t, Level> levels = levels_of(map);
  const double cell_m2 = map.passed.resolution_m() * map.passed.resolution_m();
  std::vector<double> heights;
  while (heights.size() < kMost && !levels.empty()) {
    const std::int32_t largest =
        std::max_element(levels.begin(), levels.end(), [](const auto& a, const auto& b) {
          return a.second.cells < b.second.cells;
        })->first;
    Level floor;
    std::erase_if(levels, [&](const auto& level) {
      if (std::abs(level.first - largest) > kOneFloor) return false;
      floor.cells += level.second.cells;
      floor.sum_m += level.second.sum_m;
      return true;
    });
    if (floor.cells * cell_m2 < kLeast_m2) continue;
    heights.push_back(floor.sum_m / floor.cells);
  }
  return heights;
}

}  // namespace voxlist::matching
