#include "matching/tolerant_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sys/mman.h>

namespace voxlist {

TolerantMap::TolerantMap(const VoxelMap& map, const TolerantMapConfig& config)
    : cell_m_(config.cell_m) {
  if (map.empty()) return;
  const auto factor = static_cast<std::int32_t>(std::lround(cell_m_ / map.resolution_m()));
  constexpr std::int32_t kMax = std::numeric_limits<std::int32_t>::max();
  Voxel low{kMax, kMax, kMax}, high{-kMax, -kMax, -kMax};
  for (std::size_t i = 0; i < map.block_count(); ++i) {
    const Voxel& b = map.block_position(i);
    low = {std::min(low.x, b.x), std::min(low.y, b.y), std::min(low.z, b.z)};
    high = {std::max(high.x, b.x), std::max(high.y, b.y), std::max(high.z, b.z)};
  }
  const auto cell = [&](std::int32_t v) { return floor_div(v, factor); };
  constexpr std::int32_t kMargin = 1;
  lowest_ = {cell(low.x * kBlockEdge) - kMargin, cell(low.y * kBlockEdge) - kMargin,
             floor_div(cell(low.z * kBlockEdge) - kMargin, 2)};
  size_x_ = cell(high.x * kBlockEdge + kBlockEdge - 1) + kMargin + 1 - lowest_.x + kWindow;
  size_y_ = cell(high.y * kBlockEdge + kBlockEdge - 1) + kMargin + 1 - lowest_.y + kWindow;
  size_z_ = floor_div(cell(high.z * kBlockEdge + kBlockEdge - 1) + kMargin, 2) + 1 - lowest_.z;
  bytes_.reserve(static_cast<std::size_t>(offset(0, 0, size_z_)) + kWindow);
  { auto p = (reinterpret_cast<std::uintptr_t>(bytes_.data()) + 4095) & ~std::uintptr_t{4095}; madvise(reinterpret_cast<void*>(p), bytes_.capacity() - 8192, MADV_HUGEPAGE); }
  bytes_.assign(static_cast<std::size_t>(offset(0, 0, size_z_)) + kWindow, 0);
  const auto mark = [&](std::int32_t x, std::int32_t y, std::int32_t z) {
    bytes_[static_cast<std::size_t>(
        offset(x - lowest_.x, y - lowest_.y, floor_div(z, 2) - lowest_.z))] |= 1;
  };
  map.for_each_voxel([&](const Voxel& v) {
    const Voxel c{cell(v.x), cell(v.y), cell(v.z)};
    mark(c.x, c.y, c.z - 1);
    mark(c.x, c.y, c.z + 1);
    mark(c.x, c.y, c.z);
    mark(c.x - 1, c.y, c.z);
    mark(c.x + 1, c.y, c.z);
    mark(c.x, c.y - 1, c.z);
    mark(c.x, c.y + 1, c.z);
  });
  const auto plane = static_cast<std::size_t>(size_x_) * static_cast<std::size_t>(size_y_);
  std::vector<std::uint8_t> plan(plane);
  std::vector<double> counts(static_cast<std::size_t>(size_z_));
  for (std::size_t z = 0; z < counts.size(); ++z) {
    const std::uint8_t* layer = bytes_.data() + z * plane;
    for (std::size_t i = 0; i < plane; ++i) {
      counts[z] += layer[i];
      plan[i] |= layer[i];
    }
  }
  const double ground = static_cast<double>(std::count(plan.begin(), plan.end(), 1));
  for (const double count : counts) fill_.push_back(count / ground);
  // Rows upwards: bit k of a byte is the cell k rows farther.
  for (std::int32_t z = 0; z < size_z_; ++z) {
    for (std::int32_t y = size_y_ - 2; y >= 0; --y) {
      std::uint8_t* row = bytes_.data() + offset(0, y, z);
      const std::uint8_t* next = row + size_x_;
      for (std::int32_t x = 0; x < size_x_; ++x)
        row[x] = static_cast<std::uint8_t>(row[x] | next[x] << 1);
    }
  }
}

}  // namespace voxlist
