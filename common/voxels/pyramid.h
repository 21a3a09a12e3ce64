#pragma once

#include <vector>

#include "voxels/bit_grid.h"
#include "voxels/voxel_map.h"

namespace voxlist {

/// How many cells, of which size, the pyramid of a map uses.
struct PyramidConfig {
  /// Cell edge of level 0 (m), unless the map is too large for the budget: then it doubles until it
  /// fits.
  double resolution_m = 0.08;
  /// Levels above level 0; level k stands for 2^k x 2^k translations.
  int levels = 4;
  /// Most cells of one level (bits of memory): 2^29 cells are 64 MB.
  double max_cells = 1 << 29;
};

/// A map in a stack of ever blurrier bit grids whose overlap counts bound those of the grids below.
///
/// Level 0 is the *tolerant* map: cells of edge e that hold an occupied voxel, or touch the face of
/// one that does. A node of level k stands for the poses with translations T + [0, 2^k) e on x and
/// y and angles that turn no point by more than (2^k - 1) e / 2 from the node's middle angle. Cell
/// c of level k is the OR of level 0 over [c - h, c + 3 h) on x and y, h = 2^(k-1): every cell that
/// the point in cell c can reach within the node. So the count of a node's points in level k is
/// never below the count of any of its poses in level 0.
class Pyramid {
 public:
  /// Builds all levels. The map may be empty.
  explicit Pyramid(const VoxelMap& map, const PyramidConfig& config = {});

  int top() const { return static_cast<int>(levels_.size()) - 1; }
  const BitGrid& level(int k) const { return levels_[static_cast<std::size_t>(k)]; }
  /// Cell edge of level 0, and lattice of the translations (m).
  double resolution_m() const { return resolution_m_; }

  /// The box of cells that hold the map (lowest cell and one past the highest), without the levels'
  /// margins.
  const Voxel& lowest() const { return lowest_; }
  const Voxel& end() const { return end_; }
  /// Cells of level 0 that are occupied.
  std::int64_t occupied_cells() const { return occupied_cells_; }

 private:
  double resolution_m_;
  std::int64_t occupied_cells_;
  Voxel lowest_, end_;
  std::vector<BitGrid> levels_;
};

}  // namespace voxlist
