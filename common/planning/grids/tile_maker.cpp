#include "voxlist/planning/grids/tile_maker.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace voxlist::planning {
namespace {

// Voxels along a column's edge, in a layer of it, and columns along a block's edge.
constexpr std::int32_t kAcross = kLayersInCell;
constexpr int kFull = kAcross * kAcross;
constexpr std::int32_t kColumnsInBlock = kBlockEdge / kAcross;

// Bits of a layer of a block that belong to its lowest column: four of four rows.
constexpr std::uint64_t kLowestColumn = 0x0F0F0F0F;

// A surface is told by so many of a span's layers, from its top on: 0.1 m.
constexpr std::size_t kSurfaceLayers = 5;

constexpr double kLayer_m = kFinestResolution_m;

// Layers that are no farther apart than this, and no higher together (0.1 m), with nothing close
// above, are a floor's: what has no more than so many voxels above all others there is a speck that
// noise left. Without this each square metre of a real hall's floor has an obstacle of one cell.
constexpr std::int32_t kFloorLayers = 5;
constexpr int kSpeck = 2;

template <class Visit>
void for_each_cell(const VoxelBlock& bits, const Visit& visit) {
  VoxelMap::visit_block({0, 0, 0}, bits, [&](const Voxel& cell) {
    visit(static_cast<std::size_t>(cell.x + kTileEdge * cell.y), cell.z);
  });
}

}  // namespace

void TileMaker::add_voxels(std::int32_t x, std::int32_t y, std::int32_t z, const VoxelBlock& bits) {
  for (std::int32_t k = 0; k < kBlockEdge; ++k) {
    const std::uint64_t layer = bits[static_cast<std::size_t>(k)];
    for (std::int32_t j = 0; layer != 0 && j < kColumnsInBlock * kColumnsInBlock; ++j) {
      const std::int32_t cx = j % kColumnsInBlock, cy = j / kColumnsInBlock;
      const int count = std::popcount(layer >> (kAcross * (cx + kBlockEdge * cy)) & kLowestColumn);
      const std::int32_t column = x * kColumnsInBlock + cx + kTileEdge * (y * kColumnsInBlock + cy);
      if (count > 0)
        layers_[static_cast<std::size_t>(column)].push_back({z * kBlockEdge + k, count});
    }
  }
}

void TileMaker::add_free(std::int32_t z, const VoxelBlock& bits) {
  for_each_cell(bits, [&](std::size_t column, std::int32_t k) {
    std::vector<FreeRun>& runs = free_[column];
    const std::int32_t cell = z * kBlockEdge + k;
    if (!runs.empty() && runs.back().top == cell)
      ++runs.back().top;
    else
      runs.push_back({cell, cell + 1});
  });
}

void TileMaker::add_blocked(std::int32_t z, const VoxelBlock& bits) {
  for_each_cell(bits, [&](std::size_t column, std::int32_t k) {
    blocked_[column].push_back(z * kBlockEdge + k);
  });
}

// A cell without voxels is blocked by hand.
void TileMaker::block(Layers& layers, std::int32_t cell) {
  const std::int32_t first = cell * kLayersInCell;
  const auto at = std::ranges::lower_bound(layers, first, {}, &Layer::layer);
  if (at != layers.end() && at->layer < first + kLayersInCell) return;
  Layers whole;
  for (std::int32_t k = 0; k < kLayersInCell; ++k) whole.push_back({first + k, kFull});
  layers.insert(at, whole.begin(), whole.end());
}

Span TileMaker::span_of(std::span<const Layer> layers) {
  double sum = 0.0, weights = 0.0;
  for (const Layer& layer : layers.last(std::min(layers.size(), kSurfaceLayers))) {
    sum += (layer.layer + 0.5) * kLayer_m * layer.voxels;
    weights += layer.voxels;
  }
  return {layers.front().layer, layers.back().layer + 1, static_cast<float>(sum / weights), 0.0F};
}

// Where there are few voxels at all they are one floor, at their mean height.
void TileMaker::add_flat(std::span<const Layer> flat, std::vector<Span>& spans) {
  std::size_t count = flat.size();
  while (count > 0 && flat[count - 1].voxels <= kSpeck) --count;
  if (count > 0) return add_without_gaps(flat.first(count), spans);
  Span span = span_of(flat);
  span.top = static_cast<std::int32_t>(std::floor(span.surface_m / kLayer_m)) + 1;
  spans.push_back(span);
}

void TileMaker::add_without_gaps(std::span<const Layer> layers, std::vector<Span>& spans) {
  std::size_t begin = 0;
  for (std::size_t i = 1; i <= layers.size(); ++i) {
    if (i < layers.size() && layers[i].layer == layers[i - 1].layer + 1) continue;
    spans.push_back(span_of(layers.subspan(begin, i - begin)));
    begin = i;
  }
}

std::vector<Span> TileMaker::spans_of(const Layers& layers) {
  std::vector<Span> spans;
  for (std::size_t begin = 0, end = 0; begin < layers.size(); begin = end) {
    while (++end < layers.size() && layers[end].layer - layers[end - 1].layer <= kFloorLayers) {
    }
    const std::span near = std::span(layers).subspan(begin, end - begin);
    if (near.back().layer - near.front().layer <= kFloorLayers)
      add_flat(near, spans);
    else
      add_without_gaps(near, spans);
  }
  return spans;
}

ColumnTile TileMaker::made() {
  ColumnTile tile;
  for (std::size_t column = 0; column < kColumns; ++column) {
    for (const std::int32_t cell : blocked_[column]) block(layers_[column], cell);
    tile.add(spans_of(layers_[column]), free_[column]);
  }
  return tile;
}

}  // namespace voxlist::planning
