#pragma once

#include <cstdint>

#include "voxlist/matching/counting/turned_points.h"
#include "voxlist/matching/counting/window_counters.h"
#include "voxlist/matching/search/node_bounds.h"

namespace voxlist::matching {

/// A pose of a map's lattice: an angle, and a translation in cells of the map.
struct LatticePose {
  int overlap;
  std::int32_t angle, x, y;
};

/// Counts the overlaps of the poses of nodes, 64 translations at a time: for all angles of a node
/// at once on blurred maps, then for half of them, and so on, only as long as one of the
/// translations can matter. Use from one thread.
class PoseCounter {
 public:
  /// Both must outlive it.
  PoseCounter(const DilatedMap& map, TurnedPoints& points) : map_(map), points_(points) {}

  /// Calls visit(LatticePose) for the poses of a node that overlap at least least(), which may rise
  /// from one call to the next.
  template <class Least, class Visit>
  void visit_poses(const Node& node, const Least& least, const Visit& visit) {
    visit_part(node, 0, ~std::uint64_t{0}, least, visit);
  }

 private:
  template <class Least, class Visit>
  void visit_part(const Node& node, std::int32_t part, std::uint64_t lanes, const Least& least,
                  const Visit& visit) {
    const WindowCounters counters = count(node, part, lanes, least());
    lanes &= lanes_from(counters, least());
    if (lanes == 0) return;
    if (part < TurnedPoints::kFirstSingle) {
      visit_part(node, 2 * part + 1, lanes, least, visit);
      visit_part(node, 2 * part + 2, lanes, least, visit);
      return;
    }
    constexpr std::int32_t kFactor = CoarseMap::kFactor;
    const std::int32_t angle =
        node.group * TurnedPoints::kGroup + part - TurnedPoints::kFirstSingle;
    for_each_lane(lanes, [&](int lane) {
      visit(LatticePose{count_of(counters, lane), angle, node.x * kFactor + lane / kFactor,
                        node.y * kFactor + lane % kFactor});
    });
  }

  // The counts of a part's translations. Stops early, with less than `least` in each of the lanes,
  // when none of them can reach it any more.
  WindowCounters count(const Node& node, std::int32_t part, std::uint64_t lanes, int least);

  const DilatedMap& map_;
  TurnedPoints& points_;
};

}  // namespace voxlist::matching
