#include "matching/coarse_sweep.h"

#include <algorithm>
#include <array>

#include "matching/coarse_sweep_kernel.h"

namespace voxlist {

void coarse_sweep_avx2(const SweepJob& job);
void coarse_sweep_avx512(const SweepJob& job);

namespace {

using Digits = std::array<std::vector<std::int64_t>, kSweepDigits>;

// The cells whose weight has each binary digit. A weight beyond the digits counts as several cells.
Digits by_digit(std::span<const CoarseCell> cells) {
  constexpr std::uint32_t kMostWeight = (1U << kSweepDigits) - 1;
  Digits digits;
  for (const CoarseCell& cell : cells) {
    for (std::uint32_t rest = cell.weight; rest > 0;) {
      const std::uint32_t weight = std::min(rest, kMostWeight);
      for (std::size_t p = 0; p < kSweepDigits; ++p)
        if (weight >> p & 1) digits[p].push_back(cell.bit);
      rest -= weight;
    }
  }
  return digits;
}

std::size_t words_of(Instructions instructions) {
  return instructions == Instructions::kAvx512 ? 8 : instructions == Instructions::kAvx2 ? 4 : 1;
}

}  // namespace

Instructions best_instructions() {
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
      __builtin_cpu_supports("avx512bw"))
    return Instructions::kAvx512;
  if (__builtin_cpu_supports("avx2")) return Instructions::kAvx2;
  return Instructions::kPortable;
}

NodeCounts coarse_sweep(const CoarseMap& map, std::span<const CoarseCell> cells,
                        Instructions instructions) {
  static_assert(kSweepPlanes == kCountPlanes);
  Digits digits = by_digit(cells);
  for (auto& bits : digits) bits.resize((bits.size() + 7) / 8 * 8, map.free_bit());
  const std::size_t vector_words = words_of(instructions);
  const auto bits = static_cast<std::size_t>((map.size_y() - 1) * map.row_bits() + map.size_x());
  NodeCounts counts;
  counts.words = (bits / (64 * vector_words) + 1) * vector_words;
  counts.planes.resize(kCountPlanes * counts.words);
  SweepJob job{map.words(), counts.words, {}, counts.planes.data()};
  for (std::size_t p = 0; p < kSweepDigits; ++p)
    job.digits[p] = {digits[p].data(), digits[p].size()};
  switch (instructions) {
    case Instructions::kPortable:
      sweep<std::uint64_t>(job);
      break;
    case Instructions::kAvx2:
      coarse_sweep_avx2(job);
      break;
    case Instructions::kAvx512:
      coarse_sweep_avx512(job);
      break;
  }
  return counts;
}

}  // namespace voxlist
