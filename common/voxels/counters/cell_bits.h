#pragma once
// Plain data and loops for files that are compiled for one instruction set each: nothing here calls
// anything from elsewhere, and functions have no name outside their file.

#include <cstddef>
#include <cstdint>

namespace voxlist {

/// Cells of a box, one bit each, in blocks of 8 x 8 x 8 that are made when a cell of theirs is
/// marked first. A cell is told by its key: two bits of x, of y and of z are its place in a word of
/// 4 x 4 x 4, the next one of each tells which of the block's eight words that is, and the rest is
/// the block's number in the box, x first. So the eight children of an octree's nodes of 8 and of 4
/// cells stand side by side.
struct CellBits {
  std::uint32_t* places;      ///< by block of the box: where its words are; 0: nowhere yet
  std::uint64_t* words;       ///< 8 of each block
  std::uint32_t* blocks;      ///< by place: the block
  std::uint32_t end;          ///< places from kFirstPlace to below this are taken
  std::uint32_t most_places;  ///< there are no more
  bool is_full;               ///< a block found no place
};

/// Place 1 takes what finds none.
inline constexpr std::uint32_t kNoPlace = 1, kFirstPlace = 2;

inline constexpr std::uint64_t kWordsInBlock = 8;

/// Bits of a key below the block's number.
inline constexpr int kBlockKeyBits = 9;

namespace {

// Out of the way of the loops: it is called once a block.
[[gnu::noinline]] inline std::uint32_t add_block(CellBits& cells, std::uint64_t block) {
  if (cells.end == cells.most_places) {
    cells.is_full = true;
    return kNoPlace;
  }
  const std::uint32_t place = cells.end++;
  cells.places[block] = place;
  cells.blocks[place] = static_cast<std::uint32_t>(block);
  for (std::uint64_t i = 0; i < kWordsInBlock; ++i) cells.words[place * kWordsInBlock + i] = 0;
  return place;
}

// Word `word` (key / 64), whose block is made if need be.
inline std::uint64_t& word_at(CellBits& cells, std::uint64_t word) {
  std::uint64_t place = cells.places[word / kWordsInBlock];
  if (place == 0) place = add_block(cells, word / kWordsInBlock);
  return cells.words[place * kWordsInBlock + word % kWordsInBlock];
}

// What a cell's coordinate along axis 0, 1 or 2 adds to its key.
template <class Integer>
inline Integer key_part(const Integer& cell, int axis, int block_shift) {
  return (cell & 3) << 2 * axis | (cell & 4) << (4 + axis) | (cell >> 3) << block_shift;
}

}  // namespace
}  // namespace voxlist
