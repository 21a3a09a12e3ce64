#include "voxlist/matching/search/node_bounds.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>

namespace voxlist::matching {
namespace {

// Edge of the tiles of nodes that are searched one after the other. 16 nodes of 8 cells are 5 m at
// 0.04 m, so that they look at the same part of the map. It changes speed alone. A judgement.
constexpr std::int32_t kTileNodes = 16;

}  // namespace

NodeBounds::NodeBounds(const CoarseMap& map, const TurnedPoints& points, Instructions instructions)
    : map_(map), counts_(static_cast<std::size_t>(points.groups())), highest_(counts_.size()) {
  tbb::parallel_for(std::size_t{0}, counts_.size(), [&](std::size_t group) {
    counts_[group] =
        coarse_sweep(map, points.coarse_cells(static_cast<std::int32_t>(group), map), instructions);
    for (std::size_t word = 0; word < counts_[group].words; ++word)
      highest_[group].push_back(static_cast<std::uint16_t>(largest(counters_at(group, word))));
  });
}

std::vector<Node> NodeBounds::nodes_between(int least, int most) const {
  std::vector<Node> nodes;
  for (std::size_t group = 0; group < counts_.size(); ++group) {
    for (std::size_t word = 0; word < counts_[group].words; ++word) {
      if (highest_[group][word] < least) continue;
      const WindowCounters counters = counters_at(group, word);
      const std::uint64_t lanes = lanes_from(counters, least) & ~lanes_from(counters, most + 1);
      for_each_lane(lanes, [&](int lane) {
        const std::int64_t bit = static_cast<std::int64_t>(64 * word) + lane;
        const Node node{count_of(counters, lane), static_cast<std::int32_t>(group),
                        static_cast<std::int32_t>(bit % map_.row_bits()),
                        static_cast<std::int32_t>(bit / map_.row_bits())};
        // Between the rows there are counts of no meaning.
        if (node.x < map_.size_x() && node.y < map_.size_y()) nodes.push_back(node);
      });
    }
  }
  return sorted_by_tile(nodes);
}

int NodeBounds::highest() const {
  int best = 0;
  for (const auto& words : highest_)
    for (const std::uint16_t highest : words) best = std::max<int>(best, highest);
  return best;
}

std::vector<Node> NodeBounds::sorted_by_tile(const std::vector<Node>& nodes) const {
  const std::int32_t columns = map_.size_x() / kTileNodes + 1,
                     rows = map_.size_y() / kTileNodes + 1;
  const auto tile_of = [&](const Node& node) {
    return static_cast<std::size_t>(node.y / kTileNodes * columns + node.x / kTileNodes);
  };
  std::vector<std::size_t> ends(static_cast<std::size_t>(columns * rows) + 1);
  for (const Node& node : nodes) ++ends[tile_of(node) + 1];
  std::partial_sum(ends.begin(), ends.end(), ends.begin());
  std::vector<Node> sorted(nodes.size());
  for (const Node& node : nodes) sorted[ends[tile_of(node)]++] = node;
  return sorted;
}

WindowCounters NodeBounds::counters_at(std::size_t group, std::size_t word) const {
  const NodeCounts& counts = counts_[group];
  WindowCounters counters;
  for (std::size_t p = 0; p < kCountPlanes; ++p)
    counters.planes[p] = counts.planes[p * counts.words + word];
  return counters;
}

}  // namespace voxlist::matching
