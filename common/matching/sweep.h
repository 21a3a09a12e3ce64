#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "voxels/bit_grid.h"

namespace voxlist {

/// A bit grid rearranged so that one row holds every `stride`-th cell along x: translations by
/// whole strides are then neighbouring bits, and one 64-bit word tests a scan cell at 64
/// translations at once.
class StridedGrid {
 public:
  StridedGrid(const BitGrid& grid, std::int32_t stride);

  std::int32_t stride() const { return stride_; }

  /// Bits of the cells cell + (first_x + stride * i, 0, 0), i = 0..63. Cells outside the grid are
  /// free.
  struct Row {
    const std::uint64_t* words;  // nullptr: outside the grid
    std::int64_t first;          // bit of the cell itself
  };
  Row row(const Voxel& cell) const;
  std::size_t words_per_row() const { return words_per_row_; }

 private:
  Voxel origin_;
  std::int32_t stride_, size_y_, size_z_;
  std::size_t words_per_row_;
  std::vector<std::uint64_t> words_;  // [z][y][x mod stride]
};

/// The translations that a sweep counts: cell translations (x0 + stride * i, y0 + stride * j), i <
/// nx, j < ny.
struct SweepWindow {
  std::int32_t x0 = 0, y0 = 0;
  std::int32_t nx = 0, ny = 0;
};

/// Overlap of the cells with the grid at every translation of the window: counts[j * nx + i].
/// Counts in bit planes: carry-save adders, then one pass to read the planes out. At most 65535
/// cells.
void sweep_overlaps(const StridedGrid& grid, std::span<const Voxel> cells,
                    const SweepWindow& window, std::span<std::uint16_t> counts);

}  // namespace voxlist
