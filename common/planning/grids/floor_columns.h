#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "voxlist/planning/grids/column_tile.h"
#include "voxlist/voxels/numbering.h"
#include "voxlist/voxels/occupancy_map.h"

namespace voxlist::planning {

/// Edge of the columns, and of the cells of every grid (m).
inline constexpr double kColumn_m = kPassedResolution_m;

/// A column's place in the floor plan.
struct Cell {
  std::int32_t x = 0, y = 0;

  bool operator==(const Cell&) const = default;
};

/// Columns from `low` to below `high`, whole tiles.
struct CellBox {
  Cell low, high;

  std::int32_t width() const { return high.x - low.x; }
  std::int32_t height() const { return high.y - low.y; }
  std::size_t size() const {
    return static_cast<std::size_t>(width()) * static_cast<std::size_t>(height());
  }
  bool contains(const Cell& c) const {
    return c.x >= low.x && c.x < high.x && c.y >= low.y && c.y < high.y;
  }
  std::size_t index(const Cell& c) const {
    return static_cast<std::size_t>(c.y - low.y) * static_cast<std::size_t>(width()) +
           static_cast<std::size_t>(c.x - low.x);
  }
  bool operator==(const CellBox&) const = default;
};

/// Columns of a tile that have changed: a bit for each, x first, from its lowest one on.
struct TileChange {
  Cell low;
  std::uint64_t columns = 0;
};

/// A map as columns over the floor plan: what blocks them, by voxels of 0.02 m, and what rays have
/// freed, by cells of 0.08 m. What a person keeps blocked has no voxels: it blocks whole cells.
/// Only columns that changed are made again; the same map gives the same columns, however it came.
class FloorColumns {
 public:
  /// Takes a map and its free space (MapBuilder, or MAP_UPDATE and FREE_SPACE) as they are now.
  void take(const OccupancyMap& map, const OccupancyMap& free_space);

  /// Follows blocks that changed since: `changed` in the map, `changed_free` in its free space.
  /// Tells the columns that are others now.
  std::vector<TileChange> follow(const OccupancyMap& map, const ChangedBlocks& changed,
                                 const OccupancyMap& free_space, const ChangedBlocks& changed_free);

  /// The box holds all columns; there is none without any.
  const std::optional<CellBox>& bounds() const { return bounds_; }

  /// What stands over a cell; nothing where nothing is known.
  Column at(const Cell& cell) const;

  std::size_t memory_bytes() const;

 private:
  // Where blocks are that a tile is made of, ascending.
  struct Heights {
    std::vector<std::int32_t> voxels, free;
  };

  std::uint32_t tile_of_voxels(const Voxel& block);
  std::uint32_t tile_of_free(const Voxel& block);
  std::uint32_t add_tile(const Voxel& position);
  std::vector<TileChange> remake(const std::vector<std::uint32_t>& tiles, const OccupancyMap& map,
                                 const OccupancyMap& free_space);
  void grow(const Voxel& tile);
  void place_tiles();
  std::size_t place_of(const Voxel& tile) const;
  std::uint64_t note_kinks(const Voxel& tile);
  float kink_of(const Cell& cell, float surface_m) const;

  Numbering<Voxel> positions_;  // of tiles, z = 0
  std::vector<Heights> heights_;
  std::vector<ColumnTile> tiles_;
  std::optional<CellBox> bounds_;
  // Each place in the bounds has the number of its tile and 1, or 0; empty where they are too
  // large.
  std::vector<std::uint32_t> places_;
  std::size_t placed_ = 0;  // so many tiles are in places_
};

}  // namespace voxlist::planning
