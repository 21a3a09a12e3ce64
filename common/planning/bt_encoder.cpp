#include "voxlist/planning/bt_encoder.h"

#include <octomap/OcTree.h>

#include <sstream>

namespace voxlist::planning {
namespace {

// Voxels along a tile's edge: 2^4. Larger: more is encoded anew for each change; smaller: more
// tiles to look up.
constexpr unsigned kTileBits = 4;

std::uint64_t tile_key(std::uint64_t x, std::uint64_t y, std::uint64_t z) {
  return x | y << 16 | z << 32;
}

}  // namespace

void BtEncoder::forget(const octomap::OcTreeKey& voxel) {
  tiles_.erase(tile_key(voxel[0] >> kTileBits, voxel[1] >> kTileBits, voxel[2] >> kTileBits));
}

std::string BtEncoder::encode(const octomap::OcTree& octree) {
  octree_ = &octree;
  Part all;
  if (octree.getRoot() != nullptr) append_children(*octree.getRoot(), {}, all);
  std::ostringstream out;
  out << "# Octomap OcTree binary file\n"
         "# (feel free to add / change comments, but leave the first line as it is!)\n"
         "#\nid OcTree\nsize "
      << all.nodes << "\nres " << octree.getResolution() << "\ndata\n";
  return out.str() + all.bytes;
}

BtEncoder::State BtEncoder::append(const octomap::OcTreeNode& node, const Place& place,
                                   Part& part) {
  if (octree_->nodeHasChildren(&node)) {
    return place.level + kTileBits == octree_->getTreeDepth() ? append_tile(node, place, part)
                                                              : append_children(node, place, part);
  }
  ++part.nodes;
  return octree_->isNodeOccupied(node) ? kOccupied : kFree;
}

BtEncoder::State BtEncoder::append_tile(const octomap::OcTreeNode& node, const Place& place,
                                        Part& part) {
  const auto [found, is_new] = tiles_.try_emplace(tile_key(place.x, place.y, place.z));
  Tile& tile = found->second;
  if (is_new) tile.state = append_children(node, place, tile.part);
  part.bytes += tile.part.bytes;
  part.nodes += tile.part.nodes;
  return tile.state;
}

// A node's own two bytes come before its children's. Where all eight are alike there are none.
BtEncoder::State BtEncoder::append_children(const octomap::OcTreeNode& node, const Place& place,
                                            Part& part) {
  constexpr unsigned kAllFree = 0x5555, kAllOccupied = 0xAAAA;
  const std::size_t start = part.bytes.size(), nodes = part.nodes + 1;
  part.bytes.append(2, '\0');
  part.nodes = nodes;
  unsigned states = 0;
  for (unsigned i = 0; i < 8; ++i)
    if (octree_->nodeChildExists(&node, i))
      states |= append(*octree_->getNodeChild(&node, i), place.child(i), part) << (2 * i);
  if ((states == kAllFree || states == kAllOccupied) && place.level > 0) {
    part.bytes.resize(start);
    part.nodes = nodes;
    return states == kAllFree ? kFree : kOccupied;
  }
  part.bytes[start] = static_cast<char>(states);
  part.bytes[start + 1] = static_cast<char>(states >> 8);
  return kMixed;
}

}  // namespace voxlist::planning
