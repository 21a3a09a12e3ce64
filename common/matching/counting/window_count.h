#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "voxlist/matching/counting/coarse_sweep.h"
#include "voxlist/matching/counting/window_counters.h"
#include "voxlist/matching/counting/window_map.h"
#include "voxlist/matching/scan/match_points.h"

namespace voxlist::matching {

/// Counts how many turned points fall on occupied cells of a window map, for groups of tiles of 8 x
/// 8 translations. The same counts for all instructions.
class WindowCount {
 public:
  static constexpr std::int32_t kTile = WindowMap::kTile;

  /// The counts of a group's tiles, row by row. Bit 8 i + k of a tile is the translation i cells
  /// along x and k along y from its first.
  static constexpr std::size_t kMostTiles = 8;
  using Group = std::array<WindowCounters, kMostTiles>;

  /// Points (base, m) outside the map's layers hit nothing. At most kMostSearchPoints. The map must
  /// outlive it. Safe from several threads, as everything here.
  WindowCount(const WindowMap& map, double cell_m, const MatchPoints& points,
              Instructions instructions);

  /// Tiles of a group along x and y.
  std::int32_t across() const { return across_; }
  std::int32_t down() const { return down_; }

  /// Where the turned points lie in the map, when base is in cell (x, y) of it.
  std::vector<std::int64_t> places(double yaw_rad, std::int32_t x, std::int32_t y) const;

  /// The group that begins so many tiles from there. What points beyond the map's ground add has no
  /// meaning.
  Group count(std::span<const std::int64_t> places, std::int32_t tile_x, std::int32_t tile_y) const;

 private:
  const WindowMap& map_;
  const double cells_per_m_;
  const Instructions instructions_;
  std::int32_t across_ = 1, down_ = 1;
  std::vector<double> x_m_, y_m_;
  std::vector<std::int64_t> layers_;  // place of cell (0, 0) in each point's layer
};

}  // namespace voxlist::matching
