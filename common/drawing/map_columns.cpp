#include "voxlist/drawing/map_columns.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace voxlist::drawing {
namespace {

// Height above the floor (m) from which on voxels may be a ceiling: doors and people are lower, and
// no ceiling hangs lower.
constexpr float kOverheadM = 2.0F;
// Above that, a column is looked at in levels of this height (m), over blocks of the same width:
// large enough that the few lines which meet a far wall hit most of its levels.
constexpr float kLevelM = 0.4F;
// A wall may miss two levels between two that were seen: few lines meet what is far away.
constexpr int kMaxStep = 3;
// So many levels make a wall; a ceiling with its beams and lamps fills one or two.
constexpr std::size_t kWallLevels = 3;
// The floor's height is this quantile of the columns' lowest voxels: the floor is not seen in every
// column, and where it is not the lowest voxel lies higher.
constexpr double kFloorShare = 0.25;

struct Voxel {
  Eigen::Vector2i cell;
  float height_m;

  auto key() const { return std::tuple(cell.y(), cell.x(), height_m); }
};

using Voxels = std::vector<Voxel>;

Voxels sorted_by_column(const std::vector<Eigen::Vector3f>& points, double cell_m) {
  Voxels voxels;
  for (const Eigen::Vector3f& p : points) {
    const Eigen::Vector2d cell = (p.head<2>().cast<double>() / cell_m).array().floor();
    voxels.push_back({cell.cast<int>(), p.z()});
  }
  std::sort(voxels.begin(), voxels.end(),
            [](const Voxel& a, const Voxel& b) { return a.key() < b.key(); });
  return voxels;
}

float floor_height(const Voxels& voxels) {
  std::vector<float> bottoms;
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    if (i == 0 || voxels[i].cell != voxels[i - 1].cell) {
      bottoms.push_back(voxels[i].height_m);
    }
  }
  std::sort(bottoms.begin(), bottoms.end());
  return bottoms[static_cast<std::size_t>(kFloorShare * static_cast<double>(bottoms.size() - 1))];
}

std::pair<int, int> block_of(const Voxel& voxel, double cell_m) {
  const double cells_per_block = std::max(1.0, std::round(kLevelM / cell_m));
  const Eigen::Vector2d block = (voxel.cell.cast<double>() / cells_per_block).array().floor();
  return {static_cast<int>(block.x()), static_cast<int>(block.y())};
}

/// The height up to which a wall stands in a block, from the levels (0: the lowest overhead) that
/// are occupied.
float wall_height(const std::set<int>& levels) {
  int top = -1;
  std::size_t climbed = 0;
  for (auto level = levels.begin(); level != levels.end() && *level - top <= kMaxStep; ++level) {
    top = *level;
    ++climbed;
  }
  return climbed < kWallLevels ? 0.0F : static_cast<float>(top + 1) * kLevelM;
}

Voxels without_ceilings(const Voxels& voxels, double cell_m) {
  const float overhead = floor_height(voxels) + kOverheadM;
  std::map<std::pair<int, int>, std::set<int>> levels;
  for (const Voxel& voxel : voxels) {
    if (voxel.height_m > overhead) {
      const float above = voxel.height_m - overhead;
      levels[block_of(voxel, cell_m)].insert(static_cast<int>(above / kLevelM));
    }
  }
  std::map<std::pair<int, int>, float> walls;
  for (const auto& [block, occupied] : levels) {
    walls[block] = wall_height(occupied);
  }
  Voxels kept;
  for (const Voxel& voxel : voxels) {
    if (voxel.height_m <= overhead || voxel.height_m <= overhead + walls[block_of(voxel, cell_m)]) {
      kept.push_back(voxel);
    }
  }
  return kept;
}

}  // namespace

std::vector<MapColumn> map_columns(const std::vector<Eigen::Vector3f>& points, double cell_m,
                                   double resolution_m) {
  std::vector<MapColumn> columns;
  if (points.empty()) {
    return columns;
  }
  const auto layer_m = static_cast<float>(resolution_m);
  for (const Voxel& voxel : without_ceilings(sorted_by_column(points, cell_m), cell_m)) {
    if (columns.empty() || columns.back().cell != voxel.cell) {
      columns.push_back({voxel.cell, voxel.height_m, layer_m});
    } else if (voxel.height_m > columns.back().top_m + layer_m / 2.0F) {
      // A cell that is wider than a voxel holds several at one height; they count once.
      columns.back().top_m = voxel.height_m;
      columns.back().solid_m += layer_m;
    }
  }
  return columns;
}

}  // namespace voxlist::drawing
