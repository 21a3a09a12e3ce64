#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <unordered_map>

namespace octomap {
class OcTree;
class OcTreeKey;
class OcTreeNode;
}  // namespace octomap

namespace voxlist::planning {

/// Makes the bytes of .bt files of one growing octree: every voxel free or occupied, pruned, as
/// OctoMap's writeBinary does (which works on a copy of the whole tree). It keeps the bytes of
/// tiles of 16 x 16 x 16 voxels, so that a tree costs what has changed since it was encoded last.
class BtEncoder {
 public:
  /// A voxel has become free or occupied.
  void forget(const octomap::OcTreeKey& voxel);

  /// The file of the tree, of which all such voxels were told.
  std::string encode(const octomap::OcTree& octree);

 private:
  // What a node is in the file: two bits.
  enum State : unsigned { kUnknown = 0, kFree = 1, kOccupied = 2, kMixed = 3 };

  // Bytes and nodes that a node and all below it make. One that is free or occupied as a whole
  // makes no bytes.
  struct Part {
    std::string bytes;
    std::size_t nodes = 0;
  };

  struct Tile {
    Part part;
    State state;
  };

  // Where a node lies, in its own edges.
  struct Place {
    unsigned level = 0;
    std::uint64_t x = 0, y = 0, z = 0;

    Place child(unsigned i) const {
      return {level + 1, 2 * x + (i & 1), 2 * y + (i >> 1 & 1), 2 * z + (i >> 2 & 1)};
    }
  };

  State append(const octomap::OcTreeNode& node, const Place& place, Part& part);
  State append_tile(const octomap::OcTreeNode& node, const Place& place, Part& part);
  State append_children(const octomap::OcTreeNode& node, const Place& place, Part& part);

  const octomap::OcTree* octree_ = nullptr;  // while it is encoded
  std::unordered_map<std::uint64_t, Tile> tiles_;
};

}  // namespace voxlist::planning
