#pragma once

#include <cstdint>

namespace voxlist::planning {

/// The cells of child i (2 x 2 x 2) of a word of 4 x 4 x 4 cells as a byte, in an octree's order: x
/// in bit 0, y in bit 1, z in bit 2, of child and cell alike.
constexpr std::uint64_t eight_of(std::uint64_t word, unsigned i) {
  const std::uint64_t cells = word >> (2 * (i & 1) + 4 * (i & 2) + 8 * (i & 4));
  return (cells & 0x3) | (cells >> 2 & 0xc) | (cells >> 12 & 0x30) | (cells >> 14 & 0xc0);
}

}  // namespace voxlist::planning
