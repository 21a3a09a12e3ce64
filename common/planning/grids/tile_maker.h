#pragma once

#include <array>
#include <span>
#include <vector>

#include "voxlist/planning/grids/column_tile.h"
#include "voxlist/voxels/voxel_map.h"

namespace voxlist::planning {

/// Gathers what blocks of a map hold over one tile, from the lowest block up.
class TileMaker {
 public:
  /// Voxels of 0.02 m; `x`, `y` from 0 to 3: which of the tile's 4 x 4 blocks it is.
  void add_voxels(std::int32_t x, std::int32_t y, std::int32_t z, const VoxelBlock& bits);

  /// Cells of 0.08 m that are free, and such that are occupied.
  void add_free(std::int32_t z, const VoxelBlock& bits);
  void add_blocked(std::int32_t z, const VoxelBlock& bits);

  ColumnTile made();

 private:
  // How many voxels of a column lie in one layer.
  struct Layer {
    std::int32_t layer;
    int voxels;
  };
  using Layers = std::vector<Layer>;

  void block(Layers& layers, std::int32_t cell);
  static std::vector<Span> spans_of(const Layers& layers);
  static void add_flat(std::span<const Layer> flat, std::vector<Span>& spans);
  static void add_without_gaps(std::span<const Layer> layers, std::vector<Span>& spans);
  static Span span_of(std::span<const Layer> layers);

  static constexpr std::size_t kColumns = kTileEdge * kTileEdge;
  std::array<Layers, kColumns> layers_;
  std::array<std::vector<FreeRun>, kColumns> free_;
  std::array<std::vector<std::int32_t>, kColumns> blocked_;  // cells
};

}  // namespace voxlist::planning
