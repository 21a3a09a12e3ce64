#pragma once

#include <optional>
#include <span>

#include "voxlist/voxels/counters/counter_map.h"

namespace voxlist {

/// A part of a map of counters: the cells of a box, where one is given, in cells that may be
/// larger. A larger cell has the highest count of the cells whose centres are in it, as a node of
/// an octree has: it is occupied where one of them is, else free where one is, else unknown. It
/// follows the map at the cost of what changed there.
class CutMap {
 public:
  /// Takes all that the map has. Precondition: resolution_m is not below the map's.
  CutMap(const CounterMap& map, double resolution_m,
         const std::optional<VoxelBox>& box = std::nullopt);

  /// Makes the larger blocks anew in which these blocks of the map lie, given by their numbers.
  /// Precondition: the map is that of before, counted in or forgotten in no other blocks.
  void update(const CounterMap& map, std::span<const std::uint32_t> changed);

  CounterMap& map() { return part_; }

 private:
  Voxel larger_cell(const Voxel& cell) const;
  VoxelBox larger_blocks(const Voxel& block) const;
  void make_anew(const CounterMap& map, const Voxel& larger_block);
  void raise(const CounterMap& map, std::size_t block, const Voxel& larger_block);

  double from_m_;
  std::optional<VoxelBox> box_;
  CounterMap part_;
};

}  // namespace voxlist
