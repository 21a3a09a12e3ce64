#pragma once

#include <string>

#include "voxlist/planning/octree_tiles.h"

namespace voxlist::planning {

/// The bytes of a .bt file of counters: every cell free or occupied, pruned, the same as OctoMap's
/// writeBinary makes of the same cells. Tiles that have not changed since they were encoded last
/// are copied.
class BtEncoder {
 public:
  BtEncoder(const CounterMap& map, OctreeTiles& tiles) : map_(map), tiles_(tiles.tiles()) {}

  /// The file of the whole map.
  std::string file();

  /// Nodes of the tree that the file holds.
  std::size_t nodes();

 private:
  using Part = OctreeTiles::Part;
  using Tile = OctreeTiles::Tile;
  using Iterator = OctreeTiles::Tiles::iterator;

  // What a node is in the file: two bits.
  enum State : unsigned { kUnknown = 0, kFree = 1, kOccupied = 2, kMixed = 3 };

  Part tree();
  State append(unsigned level, Iterator begin, Iterator end, Part& part);
  State append_tile(Tile& tile, Part& part);
  State append_blocks(const Tile& tile, unsigned level, std::size_t begin, std::size_t end,
                      Part& part) const;
  State append_block(std::size_t number, Part& part) const;
  static State append_word(std::uint64_t known, std::uint64_t occupied, Part& part);
  static State append_eight(std::uint64_t known, std::uint64_t occupied, Part& part);
  template <class Child>
  static State append_children(const Child& child, Part& part);

  const CounterMap& map_;
  OctreeTiles::Tiles& tiles_;
};

}  // namespace voxlist::planning
