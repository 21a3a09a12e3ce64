#include "voxlist/bus/maps/map_convert.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace voxlist::bus {
namespace {

constexpr std::uint32_t kSeed = 1;

OccupancyMap random_map() {
  std::mt19937 random(kSeed);
  std::uniform_int_distribution<int> coordinate(-200, 200);
  const auto voxel = [&] {
    return Voxel{coordinate(random), coordinate(random), coordinate(random)};
  };
  OccupancyMap map;
  for (int i = 0; i < 5000; ++i) {
    map.occupied.insert(voxel());
    map.passed.insert(voxel());
  }
  return map;
}

void expect_equal(const OccupancyMap& a, const OccupancyMap& b) {
  EXPECT_EQ(a.occupied.hash(), b.occupied.hash());
  EXPECT_EQ(a.passed.hash(), b.passed.hash());
}

MapChange change_to(const OccupancyMap& map, std::int64_t base_version, MapBlocks blocks) {
  return {.version = 1,
          .base_version = base_version,
          .resolution = resolution_of(map),
          .blocks = std::move(blocks)};
}

MapChange whole_change(const OccupancyMap& map) {
  return change_to(map, kWholeMap, to_messages(map));
}

TEST(MapConvert, AWholeMapReplacesWhateverWas) {
  const OccupancyMap sent = random_map();
  OccupancyMap received{VoxelMap(0.5), VoxelMap(0.7)};
  received.occupied.insert({1, 2, 3});
  received.passed.insert({4, 5, 6});
  EXPECT_TRUE(apply(whole_change(sent), received).replaced);
  expect_equal(received, sent);
}

TEST(MapConvert, AnIncrementCarriesTheBlocksThatChanged) {
  OccupancyMap sent = random_map(), received = random_map();
  sent.occupied.insert({1000, -1000, 7});
  sent.passed.insert({-1000, 1000, 7});
  const Voxel a = block_of({1000, -1000, 7}), b = block_of({-1000, 1000, 7}),
              nowhere{9999, 9999, 9999};
  const MapBlocks blocks = to_messages(sent, {{a, nowhere}, {b, nowhere}});
  EXPECT_EQ(blocks.occupied.size(), 2u);
  EXPECT_EQ(blocks.passed.size(), 2u);
  const MapChange increment = change_to(sent, 0, blocks);
  const AppliedChange applied = apply(increment, received);
  EXPECT_FALSE(applied.replaced);
  EXPECT_EQ(applied.changed.occupied, std::vector{a});
  EXPECT_EQ(applied.changed.passed, std::vector{b});
  expect_equal(received, sent);
  const AppliedChange again = apply(increment, received);
  EXPECT_FALSE(again.replaced);
  EXPECT_TRUE(again.changed.occupied.empty());
  EXPECT_TRUE(again.changed.passed.empty());
}

TEST(MapConvert, TellsTheBlocksThatSomethingWentFrom) {
  const OccupancyMap full = random_map();
  for (const bool passed : {false, true}) {
    OccupancyMap sent = full, received = full;
    VoxelMap& map = passed ? sent.passed : sent.occupied;
    const Voxel block = map.block_position(7);
    VoxelBlock less = map.block(7);
    auto& word = *std::find_if(less.begin(), less.end(), [](auto w) { return w != 0; });
    word &= word - 1;
    map.set_block(block, less);
    const MapBlocks blocks = to_messages(sent, {{block}, {block}});
    const AppliedChange applied = apply(change_to(sent, 0, blocks), received);
    EXPECT_FALSE(applied.replaced);
    EXPECT_EQ(passed ? applied.changed.passed : applied.changed.occupied, std::vector{block});
    expect_equal(received, sent);
  }
}

// As when its loops are closed: what has gone is told as well.
TEST(MapConvert, TellsWhatTurnsOneMapIntoAnother) {
  const OccupancyMap full = random_map();
  OccupancyMap received = full, sent;
  for (std::size_t i = 5; i < full.occupied.block_count(); ++i)
    sent.occupied.set_block(full.occupied.block_position(i), full.occupied.block(i));
  sent.passed.insert({-1000, 1000, 7});
  const MapBlocks blocks = to_messages(sent, difference(full, sent));
  EXPECT_EQ(blocks.occupied.size(), 5u);
  MapChange moved = change_to(sent, 0, blocks);
  moved.moves = 1;
  moved.T_new_old = {1.0, -2.0, 0.5};
  moved.version = 3;
  moved.base_version = 2;
  const MapChange there = MapChange{moved};
  for (const map_update_t& message : split_map(std::move(moved))) {
    EXPECT_EQ(message.moves, there.moves);
    EXPECT_EQ(message.moved[1], there.T_new_old.y_m);
  }
  EXPECT_FALSE(apply(there, received).replaced);
  expect_equal(received, sent);
}

TEST(MapConvert, TellsThatPassedCellsAloneChanged) {
  OccupancyMap sent, received;
  sent.passed.insert({1, 2, 3});
  const AppliedChange applied = apply(change_to(sent, 0, to_messages(sent)), received);
  EXPECT_FALSE(applied.replaced);
  EXPECT_EQ(applied.changed.passed, std::vector{block_of({1, 2, 3})});
  EXPECT_TRUE(received.passed.contains({1, 2, 3}));
  EXPECT_TRUE(apply(whole_change({}), received).replaced) << "they are gone now";
  EXPECT_TRUE(received.passed.empty());
}

}  // namespace
}  // namespace voxlist::bus
