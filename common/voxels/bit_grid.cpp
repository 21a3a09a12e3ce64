#include "voxels/bit_grid.h"

#include <algorithm>
#include <bit>
#include <cstdlib>

namespace voxlist {

BitGrid::BitGrid(const Voxel& origin, std::int32_t size_x, std::int32_t size_y, std::int32_t size_z)
    : origin_(origin),
      size_x_(static_cast<std::uint32_t>((size_x + 63) / 64 * 64)),
      size_y_(static_cast<std::uint32_t>(size_y)),
      size_z_(static_cast<std::uint32_t>(size_z)),
      words_per_row_(size_x_ / 64),
      words_(words_per_row_ * size_y_ * size_z_) {}

void BitGrid::set(const Voxel& v) {
  const std::uint32_t x = index(v.x, origin_.x), y = index(v.y, origin_.y),
                      z = index(v.z, origin_.z);
  if (x < size_x_ && y < size_y_ && z < size_z_) row(y, z)[x / 64] |= std::uint64_t{1} << (x % 64);
}

BitGrid BitGrid::or_shifted_x(std::span<const std::int32_t> offsets) const {
  BitGrid result(origin_, size_x(), size_y(), size_z());
  const auto words = static_cast<std::int64_t>(words_per_row_);
  // The row with as many free words on both sides as an offset can reach: no bounds to check.
  std::int64_t margin = 0;
  for (const std::int32_t offset : offsets)
    margin = std::max<std::int64_t>(margin, std::abs(offset) / 64 + 2);
  std::vector<std::uint64_t> padded(static_cast<std::size_t>(words + 2 * margin));
  for (std::size_t r = 0; r < std::size_t{size_y_} * size_z_; ++r) {
    const std::uint64_t* from = words_.data() + r * words_per_row_;
    if (std::all_of(from, from + words, [](std::uint64_t word) { return word == 0; })) continue;
    std::copy(from, from + words, padded.begin() + margin);
    std::uint64_t* to = result.words_.data() + r * words_per_row_;
    for (const std::int32_t offset : offsets) {
      const std::uint64_t* shifted = padded.data() + margin + (offset >> 6);
      const int shift = offset & 63;
      for (std::int64_t w = 0; w < words; ++w) {
        to[w] |= shift == 0 ? shifted[w] : shifted[w] >> shift | shifted[w + 1] << (64 - shift);
      }
    }
  }
  return result;
}

BitGrid BitGrid::or_shifted_y(std::span<const std::int32_t> offsets) const {
  BitGrid result(origin_, size_x(), size_y(), size_z());
  for (std::uint32_t z = 0; z < size_z_; ++z) {
    for (std::uint32_t y = 0; y < size_y_; ++y) {
      for (const std::int32_t offset : offsets) {
        const auto source = y + static_cast<std::uint32_t>(offset);
        if (source >= size_y_) continue;
        const std::uint64_t* from = row(source, z);
        std::uint64_t* to = result.row(y, z);
        for (std::size_t w = 0; w < words_per_row_; ++w) to[w] |= from[w];
      }
    }
  }
  return result;
}

BitGrid BitGrid::or_shifted_z(std::span<const std::int32_t> offsets) const {
  BitGrid result(origin_, size_x(), size_y(), size_z());
  const std::size_t layer = words_per_row_ * size_y_;
  for (std::uint32_t z = 0; z < size_z_; ++z) {
    for (const std::int32_t offset : offsets) {
      const auto source = z + static_cast<std::uint32_t>(offset);
      if (source >= size_z_) continue;
      for (std::size_t w = 0; w < layer; ++w)
        result.words_[z * layer + w] |= words_[source * layer + w];
    }
  }
  return result;
}

void BitGrid::merge(const BitGrid& other) {
  for (std::size_t w = 0; w < words_.size(); ++w) words_[w] |= other.words_[w];
}

std::int64_t BitGrid::count() const {
  std::int64_t marked = 0;
  for (const std::uint64_t word : words_) marked += std::popcount(word);
  return marked;
}

}  // namespace voxlist
