#include "voxlist/planning/ot_encoder.h"

#include <algorithm>
#include <cstring>
#include <sstream>

#include "voxlist/planning/octree_bits.h"

namespace voxlist::planning {
namespace {

// A node in the file: its log-odds, and which children it has.
constexpr std::size_t kNodeBytes = sizeof(float) + 1;

}  // namespace

OtEncoder::OtEncoder(const CounterMap& map, OctreeTiles& tiles) : map_(map), tiles_(tiles.tiles()) {
  for (unsigned i = 0; i < log_odds_.size(); ++i) {
    const int count = static_cast<int>(i) - 1 + map.rule().lowest;
    log_odds_[i] = static_cast<float>(map.rule().log_odds_of(count));
  }
}

std::string OtEncoder::file() {
  bytes_.clear();
  nodes_ = 0;
  append(0, tiles_.begin(), tiles_.end());
  std::ostringstream out;
  out << "# Octomap OcTree file\n"
         "# (feel free to add / change comments, but leave the first line as it is!)\n"
         "#\nid OcTree\nsize "
      << nodes_ << "\nres " << map_.resolution_m() << "\ndata\n";
  return out.str() + bytes_;
}

// A node comes before its children. Eight leaves that are alike become one.
template <class Child>
OtEncoder::Node OtEncoder::append_children(const Child& child) {
  const std::size_t start = bytes_.size(), nodes = nodes_++;
  bytes_.append(kNodeBytes, '\0');
  unsigned highest = 0, children = 0, alike = 0, first = 0;
  for (unsigned i = 0; i < 8; ++i) {
    const Node node = child(i);
    if (i == 0) first = node.value;
    if (node.value != 0) children |= 1u << i;
    if (node.is_leaf && node.value == first) ++alike;
    highest = std::max(highest, node.value);
  }
  const bool is_leaf = children != 0 && alike == 8;
  if (children == 0 || is_leaf) {
    bytes_.resize(start);
    nodes_ = nodes;
    return is_leaf ? append_leaf(highest) : Node{};
  }
  put(start, highest, children);
  return {highest, false};
}

OtEncoder::Node OtEncoder::append(unsigned level, Iterator begin, Iterator end) {
  if (begin == end) return {};
  if (level == OctreeTiles::kTileLevel)
    return append_blocks(begin->second, level, 0, begin->second.blocks.size());
  const unsigned shift = 3 * (OctreeTiles::kTileLevel - 1 - level);
  Iterator next = begin;
  return append_children([&](unsigned i) {
    const Iterator first = next;
    while (next != end && (next->first >> shift & 7) == i) ++next;
    return append(level + 1, first, next);
  });
}

OtEncoder::Node OtEncoder::append_blocks(const OctreeTiles::Tile& tile, unsigned level,
                                         std::size_t begin, std::size_t end) {
  if (begin == end) return {};
  if (level == OctreeTiles::kBlockLevel) {
    const CounterBlock& block = map_.block(tile.blocks[begin].second);
    return append_children([&](unsigned i) { return append_word(block, i); });
  }
  const unsigned shift = 3 * (OctreeTiles::kBlockLevel - 1 - level);
  std::size_t next = begin;
  return append_children([&](unsigned i) {
    const std::size_t first = next;
    while (next != end && (tile.blocks[next].first >> shift & 7) == i) ++next;
    return append_blocks(tile, level + 1, first, next);
  });
}

OtEncoder::Node OtEncoder::append_word(const CounterBlock& block, unsigned word) {
  unsigned value = 0;
  bool is_uniform = true;
  for (unsigned p = 0; p < 4; ++p) {
    const std::uint64_t bits = block.planes[p][word];
    is_uniform = is_uniform && (bits == 0 || ~bits == 0);
    value |= static_cast<unsigned>(bits & 1) << p;
  }
  if (is_uniform) return append_leaf(value);
  return append_children([&](unsigned i) {
    std::uint64_t eights[4];
    for (unsigned p = 0; p < 4; ++p) eights[p] = eight_of(block.planes[p][word], i);
    return append_children([&](unsigned k) {
      unsigned of_cell = 0;
      for (unsigned p = 0; p < 4; ++p) of_cell |= static_cast<unsigned>(eights[p] >> k & 1) << p;
      return append_leaf(of_cell);
    });
  });
}

OtEncoder::Node OtEncoder::append_leaf(unsigned value) {
  if (value == 0) return {};
  bytes_.append(kNodeBytes, '\0');
  put(bytes_.size() - kNodeBytes, value, 0);
  ++nodes_;
  return {value, true};
}

void OtEncoder::put(std::size_t at, unsigned value, unsigned children) {
  std::memcpy(&bytes_[at], &log_odds_[value], sizeof(float));
  bytes_[at + sizeof(float)] = static_cast<char>(children);
}

}  // namespace voxlist::planning
