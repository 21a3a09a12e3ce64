#include "matching/tolerant_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace voxlist {
namespace {

constexpr std::int32_t kCellsInLayer = 2;

struct Bounds {
  Voxel low, high;
};

// Lowest and highest voxel of the map's blocks.
Bounds bounds(const VoxelMap& map) {
  constexpr std::int32_t kFar = std::numeric_limits<std::int32_t>::max();
  Bounds b{{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
  for (std::size_t i = 0; i < map.block_count(); ++i) {
    const Voxel& v = map.block_position(i);
    b.low = {std::min(b.low.x, v.x), std::min(b.low.y, v.y), std::min(b.low.z, v.z)};
    b.high = {std::max(b.high.x, v.x), std::max(b.high.y, v.y), std::max(b.high.z, v.z)};
  }
  const std::int32_t last = kBlockEdge - 1;
  return {
      {b.low.x * kBlockEdge, b.low.y * kBlockEdge, b.low.z * kBlockEdge},
      {b.high.x * kBlockEdge + last, b.high.y * kBlockEdge + last, b.high.z * kBlockEdge + last}};
}

std::int32_t voxels_in_cell(const VoxelMap& map, double cell_m) {
  return static_cast<std::int32_t>(std::lround(cell_m / map.resolution_m()));
}

}  // namespace

TolerantMap::TolerantMap(const VoxelMap& map, double cell_m) : cell_m_(cell_m) {
  if (map.empty()) return;
  constexpr std::int32_t kMost = std::numeric_limits<std::int32_t>::max() - kWindow;
  // In double: a map that stretches over the whole lattice has more cells than 64 bits count.
  for (measure(map, cell_m_); double(size_x_) * size_y_ * size_z_ > kMost; cell_m_ *= 2.0)
    measure(map, 2.0 * cell_m_);
  columns_.assign(static_cast<std::size_t>(place(0, 0, size_z_)) + kWindow, 0);
  mark_cells(map);
  measure_fill();
  make_columns();
}

std::int32_t TolerantMap::layer(double z_m) const {
  return static_cast<std::int32_t>(std::floor(z_m / layer_m())) - lowest_.z;
}

void TolerantMap::measure(const VoxelMap& map, double cell_m) {
  const auto [low, high] = bounds(map);
  const std::int32_t factor = voxels_in_cell(map, cell_m);
  // One cell more on each side for the faces, and room for the last cells' windows.
  const auto first = [&](std::int32_t v) { return floor_div(v, factor) - 1; };
  const auto last = [&](std::int32_t v) { return floor_div(v, factor) + 1; };
  lowest_ = {first(low.x), first(low.y), floor_div(first(low.z), kCellsInLayer)};
  size_x_ = last(high.x) + 1 - lowest_.x + kWindow;
  size_y_ = last(high.y) + 1 - lowest_.y + kWindow;
  size_z_ = floor_div(last(high.z), kCellsInLayer) + 1 - lowest_.z;
}

void TolerantMap::mark_cells(const VoxelMap& map) {
  const std::int32_t factor = voxels_in_cell(map, cell_m_);
  const auto mark = [this](std::int32_t x, std::int32_t y, std::int32_t z) {
    columns_[static_cast<std::size_t>(
        place(x - lowest_.x, y - lowest_.y, floor_div(z, kCellsInLayer) - lowest_.z))] = 1;
  };
  map.for_each_voxel([&](const Voxel& v) {
    const Voxel c{floor_div(v.x, factor), floor_div(v.y, factor), floor_div(v.z, factor)};
    mark(c.x, c.y, c.z);
    mark(c.x, c.y, c.z - 1);
    mark(c.x, c.y, c.z + 1);
    mark(c.x - 1, c.y, c.z);
    mark(c.x + 1, c.y, c.z);
    mark(c.x, c.y - 1, c.z);
    mark(c.x, c.y + 1, c.z);
  });
}

void TolerantMap::measure_fill() {
  const auto area = static_cast<std::size_t>(size_x_) * static_cast<std::size_t>(size_y_);
  std::vector<std::uint8_t> plan(area);
  for (std::int32_t z = 0; z < size_z_; ++z) {
    const std::uint8_t* layer = columns_.data() + place(0, 0, z);
    std::int64_t cells = 0;
    for (std::size_t i = 0; i < area; ++i) {
      cells += layer[i];
      plan[i] |= layer[i];
    }
    fill_.push_back(static_cast<double>(cells));
    occupied_cells_ += cells;
  }
  const auto ground = static_cast<double>(std::count(plan.begin(), plan.end(), 1));
  for (double& fill : fill_) fill /= ground;
}

void TolerantMap::make_columns() {
  for (std::int32_t z = 0; z < size_z_; ++z) {
    for (std::int32_t y = size_y_ - 2; y >= 0; --y) {
      std::uint8_t* row = columns_.data() + place(0, y, z);
      const std::uint8_t* next = row + size_x_;
      for (std::int32_t x = 0; x < size_x_; ++x)
        row[x] = static_cast<std::uint8_t>(row[x] | next[x] << 1);
    }
  }
}

std::uint64_t TolerantMap::window_anywhere(std::int32_t x, std::int32_t y, std::int32_t z) const {
  if (z < 0 || z >= size_z_) return 0;
  if (holds(x, y)) return window(place(x, y, z));
  std::uint64_t bits = 0;
  for (std::int32_t i = std::max(0, -x); i < std::min(kWindow, size_x_ - x); ++i) {
    for (std::int32_t k = std::max(0, -y); k < std::min(kWindow, size_y_ - y); ++k) {
      const std::uint8_t column = columns_[static_cast<std::size_t>(place(x + i, y + k, z))];
      bits |= std::uint64_t{column & 1U} << (8 * i + k);
    }
  }
  return bits;
}

}  // namespace voxlist
