#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "matching/coarse_map.h"

namespace voxlist {

/// A coarse cell of a scan, as its bit at translation (0, 0), and how many points are in it.
struct CoarseCell {
  std::int64_t bit;
  std::uint32_t weight;
};

/// Bit planes of a count: weights may add up to 2^10 - 1.
inline constexpr std::size_t kCountPlanes = 10;

/// Counts of all nodes, in bit planes: node (x, y)'s count has its bit p at bit y * row_bits + x of
/// plane p. Between the rows there are counts of no meaning.
struct NodeCounts {
  std::size_t words = 0;  ///< of a plane
  std::vector<std::uint64_t> planes;
};

/// Which instructions are used; all give the same counts.
enum class Instructions { kPortable, kAvx2, kAvx512 };

/// The fastest that this processor has.
Instructions best_instructions();

/// Sums the weights of the cells that fall on marked ones, for every translation of the map by
/// whole coarse cells.
NodeCounts coarse_sweep(const CoarseMap& map, std::span<const CoarseCell> cells,
                        Instructions instructions);

}  // namespace voxlist
