#pragma once

#include <cstdint>
#include <vector>

#include "voxlist/matching/counting/coarse_map.h"
#include "voxlist/system/instructions.h"

namespace voxlist::matching {

/// Bit planes of a count, which is then below 2^10: searches take up to 1023 points. More planes
/// make every count slower.
inline constexpr std::size_t kCountPlanes = 10;

/// Counts of all nodes, in bit planes: node (x, y)'s count has its bit p at bit y * row_bits + x of
/// plane p. Between the rows there are counts of no meaning.
struct NodeCounts {
  std::size_t words = 0;  ///< words of a plane
  std::vector<std::uint64_t> planes;
};

/// Counts the cells that fall on marked ones, for every translation of the map by whole coarse
/// cells. A cell is given as its bit at translation (0, 0), CoarseMap::bit(). Precondition: at most
/// 2^kCountPlanes - 1 of them.
NodeCounts coarse_sweep(const CoarseMap& map, std::vector<std::int64_t> bits,
                        Instructions instructions);

}  // namespace voxlist::matching
