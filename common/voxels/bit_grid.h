#pragma once

#include <cstdint>
#include <vector>

#include "voxlist/voxels/voxel.h"

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
    return (words_[word(x, y, z)] >> (x % 64) & 1) != 0;
  }

  /// Marks a voxel; outside the box it is ignored.
  void set(const Voxel& v);

 private:
  static std::uint32_t index(std::int32_t value, std::int32_t origin) {
    return static_cast<std::uint32_t>(value - origin);
  }
  std::size_t word(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
    return (std::size_t{z} * size_y_ + y) * words_per_row_ + x / 64;
  }

  Voxel origin_;
  std::uint32_t size_x_, size_y_, size_z_;
  std::size_t words_per_row_;
  std::vector<std::uint64_t> words_;
};

}  // namespace voxlist
