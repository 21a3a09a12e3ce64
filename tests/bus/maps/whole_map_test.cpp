#include "voxlist/bus/maps/whole_map.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "voxlist/bus/maps/map_convert.h"
#include "voxlist/bus/wire.h"

namespace voxlist::bus {
namespace {

constexpr std::int32_t kBlocks = 70 * kBlocksPerChunk;  // more chunks than are unpacked at once

// Blocks with some of their words, here and there.
OccupancyMap map_of(std::int32_t blocks) {
  std::mt19937 random(11);
  const auto at = [&] { return static_cast<std::int32_t>(random() % 1000) - 500; };
  OccupancyMap map;
  while (map.occupied.block_count() + map.passed.block_count() < std::size_t(blocks)) {
    VoxelBlock bits{};
    for (std::uint64_t& word : bits) word = random() % 3 == 0 ? random() : 0;
    if (bits == VoxelBlock{}) continue;
    (random() % 3 == 0 ? map.passed : map.occupied).set_block({at(), at(), at()}, bits);
  }
  map.occupied.set_block({1, 2, 3}, {});  // erased: it is not sent
  return map;
}

MapChange word_of(const OccupancyMap& map) {
  MapChange word;
  word.utime_us = 5;
  word.map_id = 7;
  word.version = word.base_version = 9;
  word.resolution = resolution_of(map);
  word.moves = 2;
  word.T_new_old = {0.1, 0.2, 0.3};
  return word;
}

std::vector<std::uint8_t> wire_of(const map_update_t& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

TEST(WholeMap, ComesInTheMessagesOfItsChange) {
  const OccupancyMap map = map_of(2000);
  MapChange change = word_of(map);
  change.base_version = kWholeMap;
  change.blocks = to_messages(map);
  const auto expected = split_map(change);
  WholeMap whole(word_of(map), map);
  ASSERT_EQ(whole.size(), expected.size());
  for (std::size_t i = 0; i < whole.size(); ++i) {
    EXPECT_EQ(whole.bytes(i), wire_of(expected[i]).size());
    EXPECT_EQ(wire_of(whole.take(i)), wire_of(expected[i])) << "chunk " << i;
  }
}

TEST(WholeMap, OfNothingIsOneMessage) {
  WholeMap whole(word_of(OccupancyMap()), OccupancyMap());
  ASSERT_EQ(whole.size(), 1u);
  EXPECT_EQ(whole.take(0).n_blocks, 0);
}

TEST(WholeMap, IsPutTogetherAgainHoweverLargeItIs) {
  const OccupancyMap map = map_of(kBlocks);
  WholeMap whole(word_of(map), map);
  ASSERT_GT(whole.size(), 64u);
  MapAssembler assembler;
  OccupancyMap there;
  there.occupied.insert({7, 7, 7});  // of a map before
  for (std::size_t i = whole.size(); i-- > 0;)
    for (const MapChange& change : assembler.add(whole.take(i)))
      EXPECT_TRUE(apply(change, there).replaced);
  EXPECT_EQ(there.occupied.hash(), map.occupied.hash());
  EXPECT_EQ(there.passed.hash(), map.passed.hash());
}

TEST(WholeMap, TakesTheChangesThatCameBehindIt) {
  OccupancyMap map = map_of(kBlocks);
  WholeMap whole(word_of(map), map);
  MapAssembler assembler;
  OccupancyMap there;
  MapChange next = word_of(map);
  next.version = 10;
  ChangedBlocks changed;
  changed.occupied = {map.occupied.block_position(5)};
  map.occupied.set_block(changed.occupied[0], {1, 2, 3, 4, 5, 6, 7, 8});
  next.blocks = to_messages(map, changed);
  EXPECT_TRUE(assembler.add(split_map(next).front()).empty());
  for (std::size_t i = 0; i < whole.size(); ++i)
    for (const MapChange& change : assembler.add(whole.take(i))) apply(change, there);
  EXPECT_EQ(there.occupied.hash(), map.occupied.hash());
}

}  // namespace
}  // namespace voxlist::bus
