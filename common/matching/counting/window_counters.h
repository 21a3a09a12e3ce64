#pragma once

#include <bit>
#include <cstdint>

#include "voxlist/matching/counting/bit_counters.h"
#include "voxlist/matching/counting/coarse_sweep.h"

namespace voxlist::matching {

/// Counters of the 64 lanes of a word, as windows of 8 x 8 translations are counted.
using WindowCounters = BitCounters<std::uint64_t, kCountPlanes>;

/// The largest count of all lanes.
inline int largest(const WindowCounters& counters) {
  std::uint64_t lanes = ~std::uint64_t{0};
  int value = 0;
  for (std::size_t p = kCountPlanes; p-- > 0;) {
    if (const std::uint64_t with = lanes & counters.planes[p]) {
      lanes = with;
      value |= 1 << p;
    }
  }
  return value;
}

/// Lanes with at least `least`: compared from the highest digit down.
inline std::uint64_t lanes_from(const WindowCounters& counters, int least) {
  std::uint64_t greater = 0, equal = ~std::uint64_t{0};
  for (std::size_t p = kCountPlanes; p-- > 0;) {
    if (least >> p & 1) {
      equal &= counters.planes[p];
    } else {
      greater |= equal & counters.planes[p];
      equal &= ~counters.planes[p];
    }
  }
  return greater | equal;
}

inline int count_of(const WindowCounters& counters, int lane) {
  int count = 0;
  for (std::size_t p = 0; p < kCountPlanes; ++p)
    count |= static_cast<int>(counters.planes[p] >> lane & 1) << p;
  return count;
}

/// Calls visit(lane) for each lane that is set.
template <class Visit>
void for_each_lane(std::uint64_t lanes, const Visit& visit) {
  for (; lanes != 0; lanes &= lanes - 1) visit(std::countr_zero(lanes));
}

}  // namespace voxlist::matching
