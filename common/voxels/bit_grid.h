#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "voxels/voxel.h"

namespace voxlist {

/// A dense box of voxels, one bit each; rows of 64-bit words run along x. Everything outside the
/// box is free.
class BitGrid {
 public:
  /// An empty box from `origin` (its lowest voxel). Sizes are in voxels; size_x is rounded up to
  /// whole words.
  BitGrid(const Voxel& origin, std::int32_t size_x, std::int32_t size_y, std::int32_t size_z);

  bool test(const Voxel& v) const {
    const std::uint32_t x = index(v.x, origin_.x), y = index(v.y, origin_.y),
                        z = index(v.z, origin_.z);
    if (x >= size_x_ || y >= size_y_ || z >= size_z_) return false;
    return (row(y, z)[x / 64] >> (x % 64) & 1) != 0;
  }

  /// Marks a voxel; outside the box it is ignored.
  void set(const Voxel& v);

  /// The grid whose voxel v is the OR of this grid's voxels v + offset over all offsets along x (or
  /// y, or z).
  BitGrid or_shifted_x(std::span<const std::int32_t> offsets) const;
  BitGrid or_shifted_y(std::span<const std::int32_t> offsets) const;
  BitGrid or_shifted_z(std::span<const std::int32_t> offsets) const;

  /// Marks every voxel that is marked in `other`. Precondition: the same box.
  void merge(const BitGrid& other);

  /// Marked voxels.
  std::int64_t count() const;

  const Voxel& origin() const { return origin_; }
  std::int32_t size_x() const { return static_cast<std::int32_t>(size_x_); }
  std::int32_t size_y() const { return static_cast<std::int32_t>(size_y_); }
  std::int32_t size_z() const { return static_cast<std::int32_t>(size_z_); }

  /// Words of a row (x is along the row), row y of layer z, both counted from the origin.
  std::size_t words_per_row() const { return words_per_row_; }
  const std::uint64_t* row(std::uint32_t y, std::uint32_t z) const {
    return words_.data() + (std::size_t{z} * size_y_ + y) * words_per_row_;
  }

 private:
  static std::uint32_t index(std::int32_t value, std::int32_t origin) {
    return static_cast<std::uint32_t>(value - origin);
  }
  std::uint64_t* row(std::uint32_t y, std::uint32_t z) {
    return words_.data() + (std::size_t{z} * size_y_ + y) * words_per_row_;
  }

  Voxel origin_;
  std::uint32_t size_x_, size_y_, size_z_;
  std::size_t words_per_row_;
  std::vector<std::uint64_t> words_;
};

/// 64 bits of a row from bit `first` on (which may be negative or past the end: free there).
inline std::uint64_t bits_at(const std::uint64_t* row, std::size_t words, std::int64_t first) {
  const std::int64_t word = first >> 6;
  const auto shift = static_cast<unsigned>(first & 63);
  const auto get = [&](std::int64_t i) {
    return i >= 0 && i < static_cast<std::int64_t>(words) ? row[i] : 0;
  };
  return shift == 0 ? get(word) : get(word) >> shift | get(word + 1) << (64 - shift);
}

}  // namespace voxlist
