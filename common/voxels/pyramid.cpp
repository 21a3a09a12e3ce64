#include "voxels/pyramid.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace voxlist {
namespace {

Voxel coarse(const Voxel& v, std::int32_t factor) {
  return {floor_div(v.x, factor), floor_div(v.y, factor), floor_div(v.z, factor)};
}

struct Box {
  Voxel lowest, end;
};

// The box of the map's blocks, in voxels.
Box box_of(const VoxelMap& map) {
  if (map.block_count() == 0) return {{0, 0, 0}, {kBlockEdge, kBlockEdge, kBlockEdge}};
  Voxel low = map.block_position(0), high = low;
  for (std::size_t i = 1; i < map.block_count(); ++i) {
    const Voxel& b = map.block_position(i);
    low = {std::min(low.x, b.x), std::min(low.y, b.y), std::min(low.z, b.z)};
    high = {std::max(high.x, b.x), std::max(high.y, b.y), std::max(high.z, b.z)};
  }
  const std::int32_t e = kBlockEdge;
  return {{low.x * e, low.y * e, low.z * e},
          {(high.x + 1) * e, (high.y + 1) * e, (high.z + 1) * e}};
}

// Cells that the levels reach beyond the map, on x and y.
std::int32_t margin_of(const PyramidConfig& config) { return 2 << config.levels; }

// Doubles the down-sample factor until box and margins fit the budget.
std::int32_t choose_factor(const Box& box, double map_resolution_m, const PyramidConfig& config) {
  auto factor = std::max<std::int32_t>(
      1, static_cast<std::int32_t>(std::lround(config.resolution_m / map_resolution_m)));
  const double margin = 2.0 * margin_of(config);
  const auto cells = [&](std::int32_t f) {
    return (double(box.end.x - box.lowest.x) / f + margin) *
           (double(box.end.y - box.lowest.y) / f + margin) *
           (double(box.end.z - box.lowest.z) / f + 2.0);
  };
  while (cells(factor) > config.max_cells) factor *= 2;
  return factor;
}

// The cells that hold a voxel, and the six neighbours of each.
BitGrid tolerant_grid(const VoxelMap& map, const Box& cells, std::int32_t factor,
                      std::int32_t margin) {
  BitGrid occupied({cells.lowest.x - margin, cells.lowest.y - margin, cells.lowest.z - 1},
                   cells.end.x - cells.lowest.x + 2 * margin,
                   cells.end.y - cells.lowest.y + 2 * margin, cells.end.z - cells.lowest.z + 2);
  map.for_each_voxel([&](const Voxel& v) { occupied.set(coarse(v, factor)); });
  constexpr std::array<std::int32_t, 3> kNeighbours{-1, 0, 1};
  BitGrid tolerant = occupied.or_shifted_x(kNeighbours);
  tolerant.merge(occupied.or_shifted_y(kNeighbours));
  tolerant.merge(occupied.or_shifted_z(kNeighbours));
  return tolerant;
}

}  // namespace

Pyramid::Pyramid(const VoxelMap& map, const PyramidConfig& config) {
  const Box box = box_of(map);
  const std::int32_t factor = choose_factor(box, map.resolution_m(), config);
  resolution_m_ = factor * map.resolution_m();
  lowest_ = coarse(box.lowest, factor);
  end_ = coarse({box.end.x + factor - 1, box.end.y + factor - 1, box.end.z + factor - 1}, factor);

  const std::int32_t margin = margin_of(config);
  levels_.push_back(tolerant_grid(map, {lowest_, end_}, factor, margin));
  occupied_cells_ = levels_.front().count();
  for (int k = 1; k <= config.levels; ++k) {
    const std::int32_t h = 1 << (k - 1);
    const std::vector<std::int32_t> offsets = k == 1 ? std::vector<std::int32_t>{-1, 0, 1, 2}
                                                     : std::vector<std::int32_t>{-h / 2, 3 * h / 2};
    levels_.push_back(levels_.back().or_shifted_x(offsets).or_shifted_y(offsets));
  }
}

}  // namespace voxlist
