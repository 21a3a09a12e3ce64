#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "matching/tolerant_map.h"

namespace voxlist {

/// The tolerant map pooled into coarse cells of 8 x 8 lattice cells (layers stay): four bit grids
/// of which each ORs one more reach: grid (i, j) marks coarse cell c if anything lies in [8 c, 8 c
/// + 16 + 8 i) on x and [.., 16 + 8 j) on y. So a point that stays within that reach over all poses
/// of a node hits at least as often as at any pose of the node.
class CoarseMap {
 public:
  static constexpr std::int32_t kFactor = 8;

  /// `reach_m`: the farthest point of the scans to come; rows have that much margin, so that a
  /// sweep never leaves them.
  CoarseMap(const TolerantMap& map, double reach_m);

  double reach_m() const { return reach_m_; }
  std::int32_t margin() const { return margin_; }
  /// Coarse cells of the map (without margins).
  std::int32_t size_x() const { return size_x_; }
  std::int32_t size_y() const { return size_y_; }

  /// First word and bit of coarse cell (x, y) (from -margin on) of layer z in grid (wide_x, wide_y).
  std::int64_t bit(int wide_x, int wide_y, std::int32_t x, std::int32_t y, std::int32_t z) const {
    const std::int64_t grid = 2 * wide_y + wide_x;
    return ((grid * size_z_ + z) * rows_ + (y + margin_)) * row_bits_ + x + margin_;
  }
  std::int64_t row_bits() const { return row_bits_; }
  const std::uint64_t* words() const { return words_.data(); }
  /// A bit from which on everything is free, as far as a sweep goes.
  std::int64_t free_bit() const { return free_bit_; }

 private:
  double reach_m_;
  std::int32_t margin_, size_x_, size_y_, size_z_;
  std::int64_t rows_, row_bits_, free_bit_;
  std::vector<std::uint64_t> words_;
};

/// A coarse cell of a scan, as its bit at translation (0, 0), and how many points are in it.
struct CoarseCell {
  std::int64_t bit;
  std::uint32_t weight;
};

/// Bit planes of a count: weights may add up to 2^13 - 1.
inline constexpr std::size_t kCountPlanes = 13;

/// A rectangle of nodes: coarse translations x .. x + size_x, y .. y + size_y.
struct NodeWindow {
  std::int32_t x = 0, y = 0;
  std::int32_t size_x = 0, size_y = 0;
};

/// Counts of the nodes of a window, in bit planes. Rows follow each other as in the map, with
/// counts of no meaning between them: node (x, y)'s count has its bit p at bit y * row_bits + x of
/// plane p.
struct NodeCounts {
  std::size_t words = 0;  ///< of a plane
  std::vector<std::uint64_t> planes;
};

/// Which instructions are used; all give the same counts.
enum class Instructions { kPortable, kAvx2, kAvx512 };

/// The fastest that this processor has.
Instructions best_instructions();

/// Sums the weights of the cells that fall on marked ones, for every translation of the window.
void coarse_sweep(const CoarseMap& map, std::span<const CoarseCell> cells,
                  const NodeWindow& window, Instructions instructions, NodeCounts& counts);

}  // namespace voxlist
