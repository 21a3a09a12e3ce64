#include "voxlist/voxels/bit_grid.h"

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
  if (x < size_x_ && y < size_y_ && z < size_z_)
    words_[word(x, y, z)] |= std::uint64_t{1} << (x % 64);
}

}  // namespace voxlist
