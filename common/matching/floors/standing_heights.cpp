#include "voxlist/matching/floors/standing_heights.h"

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
// About a place is within so many metres of it to each side, and above and below. There one cell of
// 4 x 4 is enough.
constexpr double kAbout_m = 3.0, kFar_m = 30.0;
constexpr std::int32_t kOneOf = 4;
// Its cells in each layer of a block.
constexpr std::uint64_t kTheseOfLayer = 0x00000011'00000011;
// A robot that has moved no farther (m) has the same floors about it.
constexpr double kSamePlace_m = 0.5;

struct Level {
  double cells = 0.0, sum_m = 0.0;
};

// Voxels along a cell's edge.
std::int32_t ratio_of(const OccupancyMap& map) {
  return static_cast<std::int32_t>(
      std::lround(map.passed.resolution_m() / map.occupied.resolution_m()));
}

bool is_free_above(const OccupancyMap& map, const Voxel& cell) {
  return std::all_of(std::begin(kFreeAbove), std::end(kFreeAbove), [&](auto up) {
    return map.passed.contains({cell.x, cell.y, cell.z + up});
  });
}

// Cells whose surface has free space above, and their heights.
std::map<std::int32_t, Level> levels_of(const OccupancyMap& map) {
  const std::int32_t ratio = ratio_of(map);
  const auto cell_of = [&](std::int32_t v) { return (v - (v < 0 ? ratio - 1 : 0)) / ratio; };
  VoxelMap seen(map.passed.resolution_m());
  std::map<std::int32_t, Level> levels;
  map.occupied.for_each_voxel([&](const Voxel& voxel) {
    const Voxel cell{cell_of(voxel.x), cell_of(voxel.y), cell_of(voxel.z)};
    if (!is_free_above(map, cell) || !seen.insert(cell)) return;
    Level& level = levels[cell.z];
    level.cells += 1.0;
    level.sum_m += (voxel.z + 0.5) * map.occupied.resolution_m();
  });
  return levels;
}

// Whether anything is in a cell of `ratio` voxels along each axis.
bool is_occupied(const VoxelMap& map, const Voxel& cell, std::int32_t ratio) {
  const Voxel low{cell.x * ratio, cell.y * ratio, cell.z * ratio};
  const VoxelBlock* block = map.find_block(block_of(low));
  if (!block) return false;
  const std::uint64_t row = (std::uint64_t{1} << ratio) - 1;
  for (std::int32_t z = low.z & 7; z < (low.z & 7) + ratio; ++z)
    for (std::int32_t y = low.y & 7; y < (low.y & 7) + ratio; ++y)
      if ((*block)[static_cast<std::size_t>(z)] & (row << ((low.x & 7) + kBlockEdge * y)))
        return true;
  return false;
}

VoxelBlock thinned(VoxelBlock block) {
  for (std::uint64_t& layer : block) layer &= kTheseOfLayer;
  return block;
}

// One cell of 4 x 4 about a place.
std::map<std::int32_t, Level> levels_about(const OccupancyMap& map, const Eigen::Vector3d& at) {
  const auto ratio = ratio_of(map);
  const Eigen::Vector3d reach(kAbout_m, kAbout_m, kFar_m);
  const Voxel low = block_of(voxel_at(at - reach, map.passed.resolution_m())),
              high = block_of(voxel_at(at + reach, map.passed.resolution_m()));
  std::map<std::int32_t, Level> levels;
  const auto add = [&](const Voxel& above) {
    const Voxel cell{above.x, above.y, above.z - kFreeAbove[0]};
    if (!is_free_above(map, cell) || !is_occupied(map.occupied, cell, ratio)) return;
    Level& level = levels[cell.z];
    level.cells += 1.0;
    level.sum_m += (cell.z + 0.5) * map.passed.resolution_m();
  };
  for (std::int32_t x = low.x; x <= high.x; ++x)
    for (std::int32_t y = low.y; y <= high.y; ++y)
      for (std::int32_t z = low.z; z <= high.z; ++z)
        if (const VoxelBlock* block = map.passed.find_block({x, y, z}))
          VoxelMap::visit_block({x, y, z}, thinned(*block), add);
  return levels;
}

std::vector<double> floors_of(std::map<std::int32_t, Level> levels, double least_cells) {
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
    if (floor.cells < least_cells) continue;
    heights.push_back(floor.sum_m / floor.cells);
  }
  return heights;
}

}  // namespace

std::vector<double> standing_heights(const OccupancyMap& map) {
  const double cell_m2 = map.passed.resolution_m() * map.passed.resolution_m();
  return floors_of(levels_of(map), kLeast_m2 / cell_m2);
}

std::vector<double> standing_heights_about(const OccupancyMap& map, const Eigen::Vector3d& at) {
  const double cell_m2 = map.passed.resolution_m() * map.passed.resolution_m();
  return floors_of(levels_about(map, at), kLeast_m2 / cell_m2 / (kOneOf * kOneOf));
}

const std::vector<double>& StandingHeights::about(const OccupancyMap& map,
                                                  const Eigen::Vector3d& at) {
  if (!at_ || (at - *at_).norm() >= kSamePlace_m) {
    at_ = at;
    heights_m_ = standing_heights_about(map, at);
  }
  return heights_m_;
}

}  // namespace voxlist::matching
