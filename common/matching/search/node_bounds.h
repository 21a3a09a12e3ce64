#pragma once

#include <cstdint>
#include <vector>

#include "voxlist/matching/counting/coarse_sweep.h"
#include "voxlist/matching/counting/turned_points.h"
#include "voxlist/matching/counting/window_counters.h"

namespace voxlist::matching {

/// The translations [8 x, 8 x + 8) x [8 y, 8 y + 8) (cells of the map) at the angles of a group.
struct Node {
  /// No pose of the node overlaps more.
  int bound;
  std::int32_t group, x, y;
};

/// Upper bounds of the overlaps in all nodes of a map's lattice, by one coarse sweep for each group
/// of angles, in parallel.
class NodeBounds {
 public:
  /// The map must outlive it.
  NodeBounds(const CoarseMap& map, const TurnedPoints& points, Instructions instructions);

  /// The nodes with a bound from `least` to `most`: near ones together, which look at the same part
  /// of the map, and then by group, y, x.
  std::vector<Node> nodes_between(int least, int most) const;

  /// The largest bound of all nodes.
  int highest() const;

 private:
  std::vector<Node> sorted_by_tile(const std::vector<Node>& nodes) const;
  WindowCounters counters_at(std::size_t group, std::size_t word) const;

  const CoarseMap& map_;
  std::vector<NodeCounts> counts_;                   // for each group
  std::vector<std::vector<std::uint16_t>> highest_;  // for each group and word of its counts
};

}  // namespace voxlist::matching
