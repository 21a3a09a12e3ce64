#pragma once

#include <array>
#include <cstdint>

#include "voxlist/voxels/counters/cell_bits.h"
#include "voxlist/voxels/voxel.h"

namespace voxlist {

/// Eight words, one bit for each cell of a block of 8 x 8 x 8, in the order of their keys (see
/// CellBits).
using BlockBits = std::array<std::uint64_t, kWordsInBlock>;

/// A cell's bit in its block.
constexpr std::size_t bit_in_block(const Voxel& cell) {
  const auto part = [](std::int32_t value, int axis) {
    const auto low = static_cast<std::size_t>(value & 3),
               high = static_cast<std::size_t>(value & 4);
    return low << 2 * axis | high << (4 + axis);
  };
  return part(cell.x, 0) | part(cell.y, 1) | part(cell.z, 2);
}

/// The cell of a bit in the block at (0, 0, 0).
constexpr Voxel cell_of_bit(std::size_t bit) {
  const auto coordinate = [&](int axis) {
    return static_cast<std::int32_t>((bit >> 2 * axis & 3) | (bit >> (6 + axis) & 1) << 2);
  };
  return {coordinate(0), coordinate(1), coordinate(2)};
}

}  // namespace voxlist
