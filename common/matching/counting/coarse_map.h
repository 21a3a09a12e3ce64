#pragma once

#include <cstdint>
#include <vector>

#include "voxlist/matching/counting/dilated_map.h"

namespace voxlist::matching {

/// A dilated map pooled into coarse cells of 8 x 8 cells, for upper bounds: a node is a coarse
/// cell of translations at eight neighbouring angles. A point that is in cell q at the node's first
/// translation for one of the angles, and never beyond 16 (24) cells from the start of q's coarse
/// cell over the whole node, hits the narrow (wide) grid at q's coarse cell whenever it hits the
/// dilated map at any pose of the node. Narrow or wide is chosen for x and y each: four bit grids.
class CoarseMap {
 public:
  static constexpr std::int32_t kFactor = DilatedMap::kWindow;

  /// `reach_m`: the farthest point of the scans to come. Grids have that much margin, so that no
  /// sweep leaves them.
  CoarseMap(const DilatedMap& map, double reach_m);

  double reach_m() const { return reach_m_; }

  /// Coarse cells of the map, without margins.
  std::int32_t size_x() const { return size_x_; }
  std::int32_t size_y() const { return size_y_; }

  /// Number of the bit of a coarse cell; linear in x and y, also within the margin.
  std::int64_t bit(bool wide_x, bool wide_y, std::int32_t x, std::int32_t y, std::int32_t z) const {
    const std::int64_t grid = 2 * wide_y + wide_x;
    return ((grid * size_z_ + z) * rows_ + (y + margin_)) * row_bits_ + x + margin_;
  }

  /// Bits from one row to the next.
  std::int64_t row_bits() const { return row_bits_; }

  const std::uint64_t* words() const { return words_.data(); }

  /// A bit from which on everything is free, as far as a sweep goes.
  std::int64_t free_bit() const { return free_bit_; }

 private:
  void set(std::int64_t bit) {
    words_[static_cast<std::size_t>(bit >> 6)] |= std::uint64_t{1} << (bit & 63);
  }

  double reach_m_;
  std::int32_t margin_, size_x_, size_y_, size_z_;
  std::int64_t rows_, row_bits_, free_bit_;
  std::vector<std::uint64_t> words_;
};

}  // namespace voxlist::matching
