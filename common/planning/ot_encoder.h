#pragma once

#include <array>
#include <string>

#include "voxlist/planning/octree_tiles.h"

namespace voxlist::planning {

/// The bytes of an .ot file of counters: every cell with its log-odds, pruned where eight are
/// alike. An inner node has the highest of its children, as in OctoMap.
class OtEncoder {
 public:
  OtEncoder(const CounterMap& map, OctreeTiles& tiles);

  /// The file of the whole map.
  std::string file();

 private:
  using Iterator = OctreeTiles::Tiles::const_iterator;

  // A node of the tree: its counter's stored value, 0 where it is unknown.
  struct Node {
    unsigned value = 0;
    bool is_leaf = false;
  };

  template <class Child>
  Node append_children(const Child& child);
  Node append(unsigned level, Iterator begin, Iterator end);
  Node append_blocks(const OctreeTiles::Tile& tile, unsigned level, std::size_t begin,
                     std::size_t end);
  Node append_word(const CounterBlock& block, unsigned word);
  Node append_leaf(unsigned value);
  void put(std::size_t at, unsigned value, unsigned children);

  const CounterMap& map_;
  const OctreeTiles::Tiles& tiles_;
  std::array<float, 16> log_odds_{};  // by stored value
  std::string bytes_;
  std::size_t nodes_ = 0;
};

}  // namespace voxlist::planning
