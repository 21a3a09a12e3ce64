#pragma once

#include <array>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <span>

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

/// The memory of CellBits, which is taken as it is needed and kept for the next scan: 68 bytes a
/// block with cells, and 4 bytes for each block of the box where it was used.
class CellStore {
 public:
  using Block = std::span<const std::uint64_t, kWordsInBlock>;

  /// Forgets all cells. The box has 2^block_bits blocks, and so many may have cells.
  void begin(int block_bits, std::size_t most_blocks);

  CellBits& bits() { return bits_; }

  /// Places with a block are numbered from kFirstPlace to below this.
  std::uint32_t end() const { return bits_.end; }
  std::uint32_t block(std::uint32_t place) const { return bits_.blocks[place]; }
  Block words(std::uint32_t place) const {
    return Block(bits_.words + std::size_t{place} * kWordsInBlock, kWordsInBlock);
  }

  /// The place of a block; 0 where none of its cells is marked.
  std::uint32_t find(std::uint32_t block) const { return bits_.places[block]; }

  /// Bytes that the marked cells take, and the box's blocks at most.
  std::size_t used_bytes() const;

 private:
  struct Free {
    void operator()(std::uint32_t* memory) const { std::free(memory); }
  };

  void forget();
  void make_room(std::size_t places);

  // Left as they come from the system: what was never used takes no memory.
  std::unique_ptr<std::uint32_t, Free> places_;
  std::unique_ptr<std::uint64_t[]> words_;
  std::unique_ptr<std::uint32_t[]> blocks_;
  int block_bits_ = -1, room_bits_ = -1;
  std::size_t room_ = 0;
  CellBits bits_{};
};

}  // namespace voxlist
