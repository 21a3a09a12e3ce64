#include "voxlist/matching/counting/dilated_map.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace voxlist::matching {
namespace {

// Layers are so many cells high. Planar poses do not move points up or down, so height needs no
// finer cells than what a map's noise and a floor's slope shift points by; half as many layers take
// half the memory and the time of a dilation.
constexpr std::int32_t kCellsInLayer = 2;

// Most memory of a map (bytes), so that a byte's place fits 32 bits. Cells of 0.04 m reach it at
// about 300 x 300 m, 2.6 m high; larger maps get coarser cells.
constexpr double kMostBytes = 1 << 30;

std::int32_t voxels_in_cell(const VoxelMap& map, double cell_m) {
  return static_cast<std::int32_t>(std::lround(cell_m / map.resolution_m()));
}

std::int64_t cells_in(const std::uint8_t* bytes, std::size_t n) {
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < n; i += sizeof(std::uint64_t)) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes + i, std::min(sizeof word, n - i));
    sum += std::popcount(word);
  }
  return sum;
}

}  // namespace

DilatedMap::DilatedMap(const VoxelMap& map, double cell_m, double reach_m)
    : cell_m_(cell_m), reach_m_(reach_m) {
  if (map.empty()) return;
  for (measure(map, cell_m_); bytes() > kMostBytes; cell_m_ *= 2.0) measure(map, 2.0 * cell_m_);
  bytes_.assign(static_cast<std::size_t>(bytes()), 0);
  mark_cells(map);
  measure_fill();
  for (std::int32_t blur = 1; blur < kBlurs; ++blur) make_blurred(blur);
}

std::int32_t DilatedMap::layer(double z_m) const {
  return static_cast<std::int32_t>(std::floor(z_m / layer_m())) - lowest_.z;
}

void DilatedMap::measure(const VoxelMap& map, double cell_m) {
  const auto [low, high] = map.bounds().value();
  const std::int32_t factor = voxels_in_cell(map, cell_m);
  // One cell more on each side for the faces, and room for the last cells' windows.
  const auto first = [&](std::int32_t v) { return floor_div(v, factor) - 1; };
  const auto last = [&](std::int32_t v) { return floor_div(v, factor) + 1; };
  lowest_ = {first(low.x), first(low.y), floor_div(first(low.z), kCellsInLayer)};
  size_x_ = last(high.x) + 1 - lowest_.x + kWindow;
  size_y_ = last(high.y) + 1 - lowest_.y + kWindow;
  size_z_ = floor_div(last(high.z), kCellsInLayer) + 1 - lowest_.z;
  // A node's last window begins up to a window behind the reach.
  margin_ = (static_cast<std::int32_t>(std::ceil(reach_m_ / cell_m)) / kWindow + 3) * kWindow;
  rows_ = (size_y_ + 2 * margin_) / kWindow + 1;
  row_bytes_ = size_x_ + 2 * margin_;
}

// The size is a double: a map that stretches over the whole lattice has more cells than 64 bits
// count.
double DilatedMap::bytes() const { return (double(kBlurs) * size_z_ * rows_ + 2.0) * row_bytes_; }

void DilatedMap::mark_cells(const VoxelMap& map) {
  const std::int32_t factor = voxels_in_cell(map, cell_m_);
  const auto mark = [this](std::int32_t x, std::int32_t y, std::int32_t z) {
    const Place at =
        place(x - lowest_.x, y - lowest_.y, floor_div(z, kCellsInLayer) - lowest_.z, 0);
    std::uint8_t& byte = bytes_[static_cast<std::size_t>(at.byte)];
    byte = static_cast<std::uint8_t>(byte | 1U << at.shift);
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

void DilatedMap::measure_fill() {
  const auto layer_bytes = static_cast<std::size_t>(rows_) * static_cast<std::size_t>(row_bytes_);
  std::vector<std::uint8_t> plan(layer_bytes);
  for (std::int32_t z = 0; z < size_z_; ++z) {
    const std::uint8_t* layer = bytes_.data() + layer_bytes * static_cast<std::size_t>(z);
    for (std::size_t i = 0; i < layer_bytes; ++i) plan[i] |= layer[i];
    const std::int64_t occupied = cells_in(layer, layer_bytes);
    fill_.push_back(static_cast<double>(occupied));
    occupied_cells_ += occupied;
  }
  const auto ground = static_cast<double>(cells_in(plan.data(), layer_bytes));
  for (double& fill : fill_) fill /= ground;
}

// A blurred map is made from the one of half its blur: each cell is the OR of its cells here and
// half a blur farther, on x and y.
void DilatedMap::make_blurred(std::int32_t blur) {
  const std::int32_t step = 1 << (blur - 1);
  const auto row = static_cast<std::size_t>(row_bytes_);
  const std::size_t bytes =
      row * static_cast<std::size_t>(rows_) * static_cast<std::size_t>(size_z_);
  const std::uint8_t* from = bytes_.data() + bytes * static_cast<std::size_t>(blur - 1);
  std::uint8_t* to = bytes_.data() + bytes * static_cast<std::size_t>(blur);
  // Rows follow on each other, with margins between them: what is read past an end is free.
  std::vector<std::uint8_t> along_x(bytes + row, 0);
  for (std::size_t i = 0; i + static_cast<std::size_t>(step) < bytes; ++i)
    along_x[i] = from[i] | from[i + static_cast<std::size_t>(step)];
  for (std::size_t i = 0; i < bytes; ++i)
    to[i] = static_cast<std::uint8_t>(along_x[i] | along_x[i] >> step |
                                      along_x[i + row] << (kWindow - step));
}

std::uint64_t DilatedMap::window_anywhere(std::int32_t x, std::int32_t y, std::int32_t z) const {
  const std::int32_t far = margin_ - 2 * kWindow;
  const bool near =
      z >= 0 && z < size_z_ && x >= -far && y >= -far && x < size_x_ + far && y < size_y_ + far;
  return near ? window(place(x, y, z, 0), 0) : 0;
}

}  // namespace voxlist::matching
