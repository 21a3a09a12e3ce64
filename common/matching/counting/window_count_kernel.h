#pragma once
// Counting in a window for one width of word, for files that are compiled for one instruction set
// each. It calls nothing from elsewhere: a shared inline function that one of them compiled could
// end up in the portable code.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>

#include "voxlist/matching/counting/bit_counters.h"

namespace voxlist::matching {

inline constexpr std::size_t kWindowPlanes = 10;

/// Points to be turned, as plain numbers: arrays of `size`.
struct TurnJob {
  const double *x_m, *y_m;
  const std::int64_t* base;  ///< for each point the place of cell (0, 0) in its layer
  std::size_t size;
  double cosine, sine, cells_per_m;
  std::int32_t row_bytes;
  std::int64_t moved;    ///< added to every place
  std::int64_t* places;  ///< out
};

/// One count of a group of tiles: `size` points lie at `places` in the map.
struct CountJob {
  const std::uint8_t* map;
  const std::int64_t* places;
  std::size_t size;
  std::int64_t row_bytes;
  std::uint64_t* planes;  ///< out: kWindowPlanes for each tile of the group, row by row
};

namespace {

inline void turn_points(const TurnJob& job) {
  const auto floored = [](double value) {
    const auto whole = static_cast<std::int32_t>(value);
    return whole - (value < whole ? 1 : 0);
  };
  // The job is copied, and `places` is marked as its own memory: otherwise what the loop writes
  // might be the job itself, and the compiler would not use vectors.
  const TurnJob j = job;
  std::int64_t* __restrict places = j.places;
  for (std::size_t i = 0; i < j.size; ++i) {
    const double x_m = j.cosine * j.x_m[i] - j.sine * j.y_m[i],
                 y_m = j.sine * j.x_m[i] + j.cosine * j.y_m[i];
    places[i] = j.base[i] + j.moved + floored(y_m * j.cells_per_m) * j.row_bytes +
                floored(x_m * j.cells_per_m);
  }
}

template <class Row>
Row load_row(const std::uint8_t* from) {
  Row row;
  std::memcpy(&row, from, sizeof row);
  return row;
}

template <class Word, class Row, std::size_t... kIndices>
Word join(const Row& low, const Row& high, std::index_sequence<kIndices...>) {
  return __builtin_shufflevector(low, high, kIndices...);
}

// A word holds the tiles of a group: one row of them, or two rows where it is twice as wide as Row.
template <class Word, class Row>
void count_group(const CountJob& job) {
  constexpr std::size_t kTiles = sizeof(Word) / sizeof(std::uint64_t);
  BitCounters<Word, kWindowPlanes> counters;
  const auto load = [&](std::size_t i) -> Word {
    const std::uint8_t* from = job.map + job.places[i];
    if constexpr (sizeof(Row) == sizeof(Word))
      return load_row<Word>(from);
    else
      return join<Word>(load_row<Row>(from), load_row<Row>(from + 8 * job.row_bytes),
                        std::make_index_sequence<kTiles>());
  };
  Word words[8];
  std::size_t i = 0;
  for (; i + 8 <= job.size; i += 8) {
    for (std::size_t k = 0; k < 8; ++k) words[k] = load(i + k);
    counters.add8(words);
  }
  for (std::size_t k = 0; k < 8; ++k) words[k] = i + k < job.size ? load(i + k) : Word{};
  counters.add8(words);
  for (std::size_t p = 0; p < kWindowPlanes; ++p) {
    std::uint64_t tiles[kTiles];
    std::memcpy(tiles, &counters.planes[p], sizeof tiles);
    for (std::size_t t = 0; t < kTiles; ++t) job.planes[t * kWindowPlanes + p] = tiles[t];
  }
}

}  // namespace
}  // namespace voxlist::matching
