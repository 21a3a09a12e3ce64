#include "matching/sweep.h"

#include <algorithm>
#include <array>
#include <bit>

namespace voxlist {
namespace {

constexpr std::size_t kPlanes = 16;

// 64 counters of 16 bits, bit p of each in word p.
class BitPlaneCounters {
 public:
  // Adds eight words to the counters: seven full adders, then one carry that ripples up from
  // plane 3.
  void add(const std::array<std::uint64_t, 8>& w) {
    const auto [s0, c0] = full_add(planes_[0], w[0], w[1]);
    const auto [s1, c1] = full_add(s0, w[2], w[3]);
    const auto [s2, c2] = full_add(s1, w[4], w[5]);
    const auto [s3, c3] = full_add(s2, w[6], w[7]);
    const auto [t0, d0] = full_add(planes_[1], c0, c1);
    const auto [t1, d1] = full_add(t0, c2, c3);
    const auto [u0, carry0] = full_add(planes_[2], d0, d1);
    planes_[0] = s3;
    planes_[1] = t1;
    planes_[2] = u0;
    std::uint64_t carry = carry0;
    for (std::size_t p = 3; p < kPlanes && carry != 0; ++p) {
      const std::uint64_t overflow = planes_[p] & carry;
      planes_[p] ^= carry;
      carry = overflow;
    }
  }

  std::uint16_t count(int bit) const {
    unsigned value = 0;
    for (std::size_t p = 0; p < kPlanes; ++p)
      value |= static_cast<unsigned>(planes_[p] >> bit & 1) << p;
    return static_cast<std::uint16_t>(value);
  }

 private:
  struct SumCarry {
    std::uint64_t sum, carry;
  };
  static SumCarry full_add(std::uint64_t a, std::uint64_t b, std::uint64_t c) {
    const std::uint64_t ab = a ^ b;
    return {ab ^ c, (a & b) | (ab & c)};
  }

  std::array<std::uint64_t, kPlanes> planes_{};
};

}  // namespace

StridedGrid::StridedGrid(const BitGrid& grid, std::int32_t stride)
    : origin_(grid.origin()),
      stride_(stride),
      size_y_(grid.size_y()),
      size_z_(grid.size_z()),
      words_per_row_(static_cast<std::size_t>((grid.size_x() + 64 * stride - 1) / (64 * stride))),
      words_(words_per_row_ * static_cast<std::size_t>(stride) * static_cast<std::size_t>(size_y_) *
             static_cast<std::size_t>(size_z_)) {
  const auto rows = static_cast<std::size_t>(size_y_) * static_cast<std::size_t>(size_z_);
  const auto step = static_cast<std::size_t>(stride);
  for (std::size_t r = 0; r < rows; ++r) {
    const std::uint64_t* from = grid.row(0, 0) + r * grid.words_per_row();
    for (std::size_t w = 0; w < grid.words_per_row(); ++w) {
      for (std::uint64_t word = from[w]; word != 0; word &= word - 1) {
        const std::size_t x = w * 64 + static_cast<std::size_t>(std::countr_zero(word));
        const std::size_t bit = x / step;
        words_[(r * step + x % step) * words_per_row_ + bit / 64] |= std::uint64_t{1} << (bit % 64);
      }
    }
  }
}

StridedGrid::Row StridedGrid::row(const Voxel& cell) const {
  const std::int32_t x = cell.x - origin_.x, y = cell.y - origin_.y, z = cell.z - origin_.z;
  if (y < 0 || y >= size_y_ || z < 0 || z >= size_z_) return {nullptr, 0};
  const std::int32_t first = floor_div(x, stride_), phase = x - first * stride_;
  const auto index = (static_cast<std::size_t>(z) * static_cast<std::size_t>(size_y_) +
                      static_cast<std::size_t>(y)) *
                         static_cast<std::size_t>(stride_) +
                     static_cast<std::size_t>(phase);
  return {words_.data() + index * words_per_row_, first};
}

void sweep_overlaps(const StridedGrid& grid, std::span<const Voxel> cells,
                    const SweepWindow& window, std::span<std::uint16_t> counts) {
  std::vector<StridedGrid::Row> rows;
  rows.reserve(cells.size());
  for (std::int32_t j = 0; j < window.ny; ++j) {
    rows.clear();
    for (const Voxel& c : cells) {
      const auto row = grid.row({c.x + window.x0, c.y + window.y0 + j * grid.stride(), c.z});
      if (row.words) rows.push_back(row);
    }
    for (std::int32_t i = 0; i < window.nx; i += 64) {
      BitPlaneCounters counters;
      for (std::size_t r = 0; r < rows.size(); r += 8) {
        std::array<std::uint64_t, 8> words{};
        for (std::size_t k = 0; k < std::min<std::size_t>(8, rows.size() - r); ++k) {
          words[k] = bits_at(rows[r + k].words, grid.words_per_row(), rows[r + k].first + i);
        }
        counters.add(words);
      }
      std::uint16_t* out = counts.data() + static_cast<std::ptrdiff_t>(j) * window.nx + i;
      for (std::int32_t b = 0; b < std::min(64, window.nx - i); ++b) out[b] = counters.count(b);
    }
  }
}

}  // namespace voxlist
