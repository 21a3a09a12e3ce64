#pragma once

#include <cstdlib>
#include <memory>
#include <span>

#include "voxlist/voxels/counters/block_cells.h"

namespace voxlist {

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
