#pragma once

#include <bit>
#include <vector>

#include "voxlist/voxels/counters/counter_map.h"
#include "voxlist/voxels/voids/void_scan.h"

namespace voxlist {

/// How many hits and voids weigh against each other, counted as passes are. What was seen once is
/// gone after 4 voids, what stood for long after 6; where it was void for long, a thing is there
/// after 3 hits. Hits weigh more because a scan that hits a thing is sure of it, and one that sees
/// a void past a table's top or a door's edge is not.
inline constexpr CounterRule kVoidCounts{.hit = 3, .pass = 1, .lowest = -7, .highest = 5};

/// Where space is void, as all scans say that were counted so far: cells whose voids outweigh their
/// hits. The order of scans matters.
class VoidCells {
 public:
  /// Precondition: cells are a multiple of the map's voxels.
  VoidCells(double cell_m, double voxel_m);

  /// What a scan changes in a block: cells that have become void for good, so that what was hit
  /// there is forgotten; and those that were void and are not any more, or the other way round.
  struct Change {
    Voxel at;
    BlockBits emptied{}, turned{};

    bool operator==(const Change&) const = default;
  };

  /// Counts what a scan says of a block.
  Change count(const VoidScan::Block& seen);

  /// Cells of a block that hold something, and that the scan sees to be void.
  BlockBits doubted(const VoidScan::Block& seen) const;

  /// The voxels of a block of the map that lie in void cells.
  VoxelBlock void_voxels(const Voxel& block) const;

  /// Calls visit(block of the map, voxels in it) for the voxels of these cells of a block.
  template <class Visit>
  void for_each_part(const Voxel& at, const BlockBits& cells, const Visit& visit) const;

  /// The counters, for who takes scans out.
  CounterMap& counters() { return counters_; }
  const CounterMap& counters() const { return counters_; }

 private:
  VoxelBox voxels_of(const Voxel& cell) const;
  bool is_void(const Voxel& cell) const { return counters_.at(cell) == CellState::kFree; }

  std::int32_t voxels_;  // along a cell's edge
  CounterMap counters_;
};

/// The voxels of a block, given by its position, that lie in a box.
VoxelBlock voxels_in(const VoxelBox& box, const Voxel& block);

template <class Visit>
void VoidCells::for_each_part(const Voxel& at, const BlockBits& cells, const Visit& visit) const {
  for (std::size_t w = 0; w < cells.size(); ++w) {
    for (std::uint64_t left = cells[w]; left != 0; left &= left - 1) {
      const Voxel in = cell_of_bit(64 * w + static_cast<std::size_t>(std::countr_zero(left)));
      const VoxelBox box =
          voxels_of({at.x * kBlockEdge + in.x, at.y * kBlockEdge + in.y, at.z * kBlockEdge + in.z});
      const Voxel first = block_of(box.lowest), last = block_of(box.highest);
      for (std::int32_t z = first.z; z <= last.z; ++z)
        for (std::int32_t y = first.y; y <= last.y; ++y)
          for (std::int32_t x = first.x; x <= last.x; ++x)
            visit(Voxel{x, y, z}, voxels_in(box, {x, y, z}));
    }
  }
}

}  // namespace voxlist
