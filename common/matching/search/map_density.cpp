#include "voxlist/matching/search/map_density.h"

#include "voxlist/voxels/halved.h"

namespace voxlist::matching {
namespace {

// Cells for one of twice the edge: four on a closed surface, one where points lie far apart.
constexpr double kClosed = 2.5;
// Coarser cells tell too little, however few the scans.
constexpr double kCoarsest_m = 0.16;

double occupied(const VoxelMap& map) { return static_cast<double>(map.size()); }

}  // namespace

double closed_cell_m(const VoxelMap& map) {
  VoxelMap cells = halved(map), larger = halved(cells);
  while (cells.resolution_m() < kCoarsest_m && occupied(cells) < kClosed * occupied(larger)) {
    cells = std::move(larger);
    larger = halved(cells);
  }
  return cells.resolution_m();
}

}  // namespace voxlist::matching
