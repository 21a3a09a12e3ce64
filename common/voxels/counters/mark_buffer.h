#pragma once
// As ray_kernel.h: for files that are compiled for one instruction set each.

#if defined(__AVX2__)
#include <immintrin.h>
#endif

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "voxlist/voxels/counters/cell_bits.h"

namespace voxlist {
namespace {

/// Bits that are to be marked in words, kept until there are many: then one loop marks them, which
/// does not wait for what comes next.
class MarkBuffer {
 public:
  explicit MarkBuffer(CellBits& cells) : cells_(cells) {}
  ~MarkBuffer() { flush(); }
  MarkBuffer(const MarkBuffer&) = delete;
  MarkBuffer& operator=(const MarkBuffer&) = delete;

  /// Takes the lanes that are all ones in `which`.
  template <class Integers>
  void add(const Integers& which, const Integers& words, const Integers& bits) {
    if (size_ + sizeof(Integers) / 8 > kSize) flush();
    const unsigned mask = mask_of(which);
    pack(mask, words, words_ + size_);
    pack(mask, bits, bits_ + size_);
    size_ += static_cast<std::size_t>(__builtin_popcount(mask));
  }

  /// Whether there is a lane of all ones.
  template <class Integers>
  static bool has_any(const Integers& which) {
    return mask_of(which) != 0;
  }

 private:
  static constexpr std::size_t kSize = 1024;

#if defined(__AVX512F__)
  template <class Integers>
  static unsigned mask_of(const Integers& which) {
    return _mm512_movepi64_mask(reinterpret_cast<const __m512i&>(which));
  }

  template <class Integers>
  static void pack(unsigned mask, const Integers& values, std::uint64_t* to) {
    const auto lanes = static_cast<__mmask8>(mask);
    _mm512_storeu_si512(
        to, _mm512_maskz_compress_epi64(lanes, reinterpret_cast<const __m512i&>(values)));
  }
#else
  template <class Integers>
  static unsigned mask_of(const Integers& which) {
    return static_cast<unsigned>(_mm256_movemask_pd(reinterpret_cast<const __m256d&>(which)));
  }

  // Moves halves of lanes, as 64-bit lanes cannot be moved by a table.
  template <class Integers>
  static void pack(unsigned mask, const Integers& values, std::uint64_t* to) {
    alignas(32) static constexpr std::uint32_t kOrders[16][8] = {
        {0, 1, 2, 3, 4, 5, 6, 7}, {0, 1, 2, 3, 4, 5, 6, 7}, {2, 3, 0, 1, 4, 5, 6, 7},
        {0, 1, 2, 3, 4, 5, 6, 7}, {4, 5, 0, 1, 2, 3, 6, 7}, {0, 1, 4, 5, 2, 3, 6, 7},
        {2, 3, 4, 5, 0, 1, 6, 7}, {0, 1, 2, 3, 4, 5, 6, 7}, {6, 7, 0, 1, 2, 3, 4, 5},
        {0, 1, 6, 7, 2, 3, 4, 5}, {2, 3, 6, 7, 0, 1, 4, 5}, {0, 1, 2, 3, 6, 7, 4, 5},
        {4, 5, 6, 7, 0, 1, 2, 3}, {0, 1, 4, 5, 6, 7, 2, 3}, {2, 3, 4, 5, 6, 7, 0, 1},
        {0, 1, 2, 3, 4, 5, 6, 7}};
    const __m256i order = _mm256_load_si256(reinterpret_cast<const __m256i*>(kOrders[mask]));
    _mm256_storeu_si256(
        reinterpret_cast<__m256i*>(to),
        _mm256_permutevar8x32_epi32(reinterpret_cast<const __m256i&>(values), order));
  }
#endif

  void flush() {
    for (std::size_t i = 0; i < size_; ++i) word_at(cells_, words_[i]) |= bits_[i];
    size_ = 0;
  }

  CellBits& cells_;
  std::size_t size_ = 0;
  alignas(64) std::uint64_t words_[kSize], bits_[kSize];
};

}  // namespace
}  // namespace voxlist
