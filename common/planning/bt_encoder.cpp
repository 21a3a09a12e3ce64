#include "voxlist/planning/bt_encoder.h"

#include <array>
#include <bit>
#include <sstream>

#include "voxlist/planning/octree_bits.h"

namespace voxlist::planning {
namespace {

constexpr unsigned kAllFree = 0x5555, kAllOccupied = 0xAAAA;
constexpr std::uint64_t kAll = ~std::uint64_t{0};

// Bits of a byte, a place free after each.
constexpr std::array<std::uint16_t, 256> kDoubled = [] {
  std::array<std::uint16_t, 256> table{};
  for (unsigned byte = 0; byte < 256; ++byte)
    for (unsigned i = 0; i < 8; ++i)
      table[byte] = static_cast<std::uint16_t>(table[byte] | (byte >> i & 1) << 2 * i);
  return table;
}();

}  // namespace

std::string BtEncoder::file() {
  const Part all = tree();
  std::ostringstream out;
  out << "# Octomap OcTree binary file\n"
         "# (feel free to add / change comments, but leave the first line as it is!)\n"
         "#\nid OcTree\nsize "
      << all.nodes << "\nres " << map_.resolution_m() << "\ndata\n";
  return out.str() + all.bytes;
}

std::size_t BtEncoder::nodes() { return tree().nodes; }

OctreeTiles::Part BtEncoder::tree() {
  Part all;
  if (!tiles_.empty()) append(0, tiles_.begin(), tiles_.end(), all);
  return all;
}

// A node's own two bytes come before its children's. Where all eight are alike there are none.
template <class Child>
BtEncoder::State BtEncoder::append_children(const Child& child, Part& part) {
  const std::size_t start = part.bytes.size(), nodes = part.nodes;
  part.bytes.append(2, '\0');
  ++part.nodes;
  unsigned states = 0;
  for (unsigned i = 0; i < 8; ++i) states |= child(i) << 2 * i;
  if (states == 0 || states == kAllFree || states == kAllOccupied) {
    part.bytes.resize(start);
    part.nodes = nodes + (states == 0 ? 0 : 1);
    return states == 0 ? kUnknown : states == kAllFree ? kFree : kOccupied;
  }
  part.bytes[start] = static_cast<char>(states & 0xff);
  part.bytes[start + 1] = static_cast<char>(states >> 8);
  return kMixed;
}

BtEncoder::State BtEncoder::append(unsigned level, Iterator begin, Iterator end, Part& part) {
  if (begin == end) return kUnknown;
  if (level == OctreeTiles::kTileLevel) return append_tile(begin->second, part);
  const unsigned shift = 3 * (OctreeTiles::kTileLevel - 1 - level);
  Iterator next = begin;
  return append_children(
      [&](unsigned i) {
        const Iterator first = next;
        while (next != end && (next->first >> shift & 7) == i) ++next;
        return append(level + 1, first, next, part);
      },
      part);
}

BtEncoder::State BtEncoder::append_tile(Tile& tile, Part& part) {
  if (!tile.is_encoded) {
    tile.part = {};
    tile.state = append_blocks(tile, OctreeTiles::kTileLevel, 0, tile.blocks.size(), tile.part);
    tile.is_encoded = true;
  }
  part.bytes += tile.part.bytes;
  part.nodes += tile.part.nodes;
  return static_cast<State>(tile.state);
}

BtEncoder::State BtEncoder::append_blocks(const Tile& tile, unsigned level, std::size_t begin,
                                          std::size_t end, Part& part) const {
  if (begin == end) return kUnknown;
  if (level == OctreeTiles::kBlockLevel) return append_block(tile.blocks[begin].second, part);
  const unsigned shift = 3 * (OctreeTiles::kBlockLevel - 1 - level);
  std::size_t next = begin;
  return append_children(
      [&](unsigned i) {
        const std::size_t first = next;
        while (next != end && (tile.blocks[next].first >> shift & 7) == i) ++next;
        return append_blocks(tile, level + 1, first, next, part);
      },
      part);
}

BtEncoder::State BtEncoder::append_block(std::size_t number, Part& part) const {
  const BlockBits known = map_.known(number), occupied = map_.occupied(number);
  return append_children([&](unsigned i) { return append_word(known[i], occupied[i], part); },
                         part);
}

BtEncoder::State BtEncoder::append_word(std::uint64_t known, std::uint64_t occupied, Part& part) {
  if (known == 0) return kUnknown;
  if (known == kAll && (occupied == 0 || occupied == kAll)) {
    ++part.nodes;
    return occupied == 0 ? kFree : kOccupied;
  }
  return append_children(
      [&](unsigned i) { return append_eight(eight_of(known, i), eight_of(occupied, i), part); },
      part);
}

BtEncoder::State BtEncoder::append_eight(std::uint64_t known, std::uint64_t occupied, Part& part) {
  if (known == 0) return kUnknown;
  ++part.nodes;
  const unsigned states = kDoubled[known & ~occupied] | kDoubled[occupied] << 1;
  if (states == kAllFree) return kFree;
  if (states == kAllOccupied) return kOccupied;
  part.nodes += static_cast<std::size_t>(std::popcount(known));
  part.bytes += static_cast<char>(states & 0xff);
  part.bytes += static_cast<char>(states >> 8);
  return kMixed;
}

}  // namespace voxlist::planning
