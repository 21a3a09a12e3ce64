#pragma once

#include <cstddef>
#include <cstdint>

namespace voxlist::matching {

/// A vector of counters in bit planes: counter i's bit p is bit i of planes[p]. Word: an unsigned
/// integer or a vector of them.
template <class Word, std::size_t kPlanes>
struct BitCounters {
  Word planes[kPlanes] = {};

  /// Adds eight words to the counters: seven full adders, then a carry that ripples.
  void add8(const Word* w) { ripple(3, add_to_8(w)); }

  /// Adds twice eight, which carry once: words(i) fills an array with the i-th eight.
  template <class Words>
  void add16(const Words& words) {
    Word w[8], carry;
    words(0, w);
    const Word first = add_to_8(w);
    words(1, w);
    planes[3] = full_add(planes[3], first, add_to_8(w), carry);
    ripple(4, carry);
  }

 private:
  // Adds into the planes of ones, twos and fours; returns the carry into the eights.
  Word add_to_8(const Word* w) {
    Word c0, c1, c2, c3, d0, d1, e;
    Word s = full_add(planes[0], w[0], w[1], c0);
    s = full_add(s, w[2], w[3], c1);
    s = full_add(s, w[4], w[5], c2);
    planes[0] = full_add(s, w[6], w[7], c3);
    s = full_add(planes[1], c0, c1, d0);
    planes[1] = full_add(s, c2, c3, d1);
    planes[2] = full_add(planes[2], d0, d1, e);
    return e;
  }

  void ripple(std::size_t from, Word carry) {
    for (std::size_t p = from; p < kPlanes; ++p) {
      const Word overflow = planes[p] & carry;
      planes[p] ^= carry;
      carry = overflow;
    }
  }

  static Word full_add(const Word& a, const Word& b, const Word& c, Word& carry) {
    const Word ab = a ^ b;
    carry = (a & b) | (ab & c);
    return ab ^ c;
  }
};

}  // namespace voxlist::matching
