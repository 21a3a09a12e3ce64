#pragma once
// The sweep for one width of word, for files that are compiled for one instruction set each. It
// calls nothing from elsewhere: a shared inline function that one of them compiled could end up in
// the portable code.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "voxlist/matching/counting/bit_counters.h"

namespace voxlist::matching {

inline constexpr std::size_t kSweepPlanes = 10;

/// Bits that a sweep takes at once.
inline constexpr std::size_t kSweptAtOnce = 16;

/// One sweep as plain numbers: counter i counts the marked ones among the map's bits at `bits` + i.
struct SweepJob {
  const std::uint64_t* map;
  std::size_t words;  ///< of 64 counters each, a multiple of the vector's words
  const std::int64_t* bits;
  std::size_t size;    ///< how many `bits` there are, a multiple of kSweptAtOnce
  std::uint64_t* out;  ///< planes one after the other, `words` each
};

namespace {

// Loads the bits from one on: from its byte and from the next one. Where both hold a bit, they
// agree.
template <class Word>
Word load_bits(const std::uint64_t* words, std::int64_t bit) {
  static_assert(std::endian::native == std::endian::little);
  const std::byte* from = reinterpret_cast<const std::byte*>(words) + (bit >> 3);
  Word low, high;
  std::memcpy(&low, from, sizeof low);
  std::memcpy(&high, from + 1, sizeof high);
  const auto shift = static_cast<std::uint64_t>(bit & 7);
  return (low >> shift) | (high << (8 - shift));
}

template <class Word>
void sweep(const SweepJob& job) {
  constexpr std::size_t kWords = sizeof(Word) / sizeof(std::uint64_t);
  for (std::size_t word = 0; word < job.words; word += kWords) {
    const auto at = static_cast<std::int64_t>(64 * word);
    BitCounters<Word, kSweepPlanes> counters;
    for (std::size_t i = 0; i < job.size; i += kSweptAtOnce) {
      counters.add16([&](std::size_t eight, Word* w) {
        const std::int64_t* bits = job.bits + i + 8 * eight;
        for (std::size_t k = 0; k < 8; ++k) w[k] = load_bits<Word>(job.map, bits[k] + at);
      });
    }
    for (std::size_t p = 0; p < kSweepPlanes; ++p)
      std::memcpy(job.out + p * job.words + word, &counters.planes[p], sizeof(Word));
  }
}

}  // namespace
}  // namespace voxlist::matching
