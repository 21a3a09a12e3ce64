#include "matching/coarse_sweep.h"

#include <algorithm>
#include <cmath>

#include "matching/coarse_sweep_kernel.h"

namespace voxlist {

void coarse_sweep_avx2(const SweepJob& job);
void coarse_sweep_avx512(const SweepJob& job);

CoarseMap::CoarseMap(const TolerantMap& map, double reach_m) : reach_m_(reach_m) {
  constexpr std::int32_t kReach = 3;  // coarse cells that the widest grid looks ahead
  margin_ = static_cast<std::int32_t>(std::ceil(reach_m / (map.cell_m() * kFactor))) + kReach + 1;
  size_x_ = (map.size_x() + kFactor - 1) / kFactor;
  size_y_ = (map.size_y() + kFactor - 1) / kFactor;
  size_z_ = map.size_z();
  rows_ = size_y_ + 2 * margin_;
  row_bits_ = size_x_ + 2 * margin_;
  // A sweep reads whole vectors past the end, and the last row is a free one for what fills up a
  // vector of cells.
  constexpr std::int64_t kWidest = 32;
  free_bit_ = 4 * size_z_ * rows_ * row_bits_;
  words_.assign(static_cast<std::size_t>((free_bit_ + rows_ * row_bits_) / 64 + kWidest), 0);
  const auto set = [this](std::int64_t bit) {
    words_[static_cast<std::size_t>(bit >> 6)] |= std::uint64_t{1} << (bit & 63);
  };
  for (std::int32_t z = 0; z < size_z_; ++z) {
    for (std::int32_t y = 0; y < size_y_; ++y) {
      for (std::int32_t x = 0; x < size_x_; ++x) {
        // A coarse cell is one window; those at the map's end may reach past it.
        const bool whole = map.holds(x * kFactor, y * kFactor);
        bool any = whole && map.window(map.offset(x * kFactor, y * kFactor, z)) != 0;
        if (!whole) {
          for (int i = 0; i < 64 && !any; ++i)
            any = map.occupied(x * kFactor + i % 8, y * kFactor + i / 8, z);
        }
        if (!any) continue;
        for (int wide_y = 0; wide_y < 2; ++wide_y)
          for (int wide_x = 0; wide_x < 2; ++wide_x)
            for (int dy = 0; dy <= 1 + wide_y; ++dy)
              for (int dx = 0; dx <= 1 + wide_x; ++dx) set(bit(wide_x, wide_y, x - dx, y - dy, z));
      }
    }
  }
}

Instructions best_instructions() {
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl"))
    return Instructions::kAvx512;
  if (__builtin_cpu_supports("avx2")) return Instructions::kAvx2;
  return Instructions::kPortable;
}

void coarse_sweep(const CoarseMap& map, std::span<const CoarseCell> cells,
                  const NodeWindow& window, Instructions instructions, NodeCounts& counts) {
  static_assert(kSweepPlanes == kCountPlanes);
  // A weight beyond the digits counts as several cells.
  constexpr std::uint32_t kMostWeight = (1U << kSweepDigits) - 1;
  std::array<std::vector<std::int64_t>, kSweepDigits> digits;
  for (const CoarseCell& cell : cells) {
    for (std::uint32_t rest = cell.weight; rest > 0;) {
      const std::uint32_t weight = std::min(rest, kMostWeight);
      for (std::size_t p = 0; p < kSweepDigits; ++p)
        if (weight >> p & 1) digits[p].push_back(cell.bit);
      rest -= weight;
    }
  }
  const std::size_t words = instructions == Instructions::kAvx512 ? 8
                            : instructions == Instructions::kAvx2 ? 4
                                                                  : 1;
  const std::int64_t bits = (window.size_y - 1) * map.row_bits() + window.size_x;
  const auto vectors = static_cast<std::size_t>(bits) / (64 * words) + 1;
  SweepJob job{map.words(), window.y * map.row_bits() + window.x, vectors * words, {}, nullptr};
  for (std::size_t p = 0; p < kSweepDigits; ++p) {
    while (digits[p].size() % 8 != 0) digits[p].push_back(map.free_bit() - job.first_bit);
    job.digits[p] = {digits[p].data(), digits[p].size()};
  }
  counts.words = job.words;
  counts.planes.resize(kCountPlanes * counts.words);
  job.out = counts.planes.data();
  switch (instructions) {
    case Instructions::kPortable:
      return sweep<std::uint64_t>(job);
    case Instructions::kAvx2:
      return coarse_sweep_avx2(job);
    case Instructions::kAvx512:
      return coarse_sweep_avx512(job);
  }
}

}  // namespace voxlist
