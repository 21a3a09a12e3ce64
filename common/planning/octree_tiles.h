#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "voxlist/voxels/counters/counter_map.h"

namespace voxlist::planning {

/// The blocks of a map of counters in the order of an octree: nodes of 64 cells by their Morton
/// keys, and in each its blocks, which are nodes of 8 cells.
class OctreeTiles {
 public:
  /// An octree has 16 levels below its root; tiles are nodes of the tenth, blocks of the 13th.
  static constexpr unsigned kLevels = 16, kTileLevel = 10, kBlockLevel = 13;

  /// Bytes that a node and all below it make in a .bt file, with how many nodes that are. One that
  /// is free or occupied as a whole makes none.
  struct Part {
    std::string bytes;
    std::size_t nodes = 0;
  };

  struct Tile {
    /// Block numbers by their place in the tile: Morton keys of nine bits, ascending.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> blocks;
    bool is_encoded = false;
    unsigned state = 0;
    Part part;
  };

  /// By Morton key.
  using Tiles = std::map<std::uint32_t, Tile>;

  /// Takes in the blocks of the map that have changed, given by their numbers. Blocks outside of
  /// the octree are left out.
  void update(const CounterMap& map, std::span<const std::uint32_t> changed);

  Tiles& tiles() { return tiles_; }

 private:
  void add(const Voxel& block, std::uint32_t number);

  Tiles tiles_;
};

}  // namespace voxlist::planning
