#include "bus/map_convert.h"

#include <gtest/gtest.h>

#include <random>

namespace voxlist {
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
  EXPECT_TRUE(apply(whole_change(sent), received));
  expect_equal(received, sent);
}

TEST(MapConvert, AnIncrementCarriesTheBlocksThatChanged) {
  OccupancyMap sent = random_map(), received = random_map();
  sent.occupied.insert({1000, -1000, 7});
  sent.passed.insert({-1000, 1000, 7});
  const Voxel nowhere{9999, 9999, 9999};
  const MapBlocks blocks = to_messages(
      sent, {{block_of({1000, -1000, 7}), nowhere}, {block_of({-1000, 1000, 7}), nowhere}});
  EXPECT_EQ(blocks.occupied.size(), 1u);
  EXPECT_EQ(blocks.passed.size(), 1u);
  const MapChange increment = change_to(sent, 0, blocks);
  EXPECT_TRUE(apply(increment, received));
  expect_equal(received, sent);
  EXPECT_FALSE(apply(increment, received));
}

TEST(MapConvert, TellsThatPassedCellsAloneChanged) {
  OccupancyMap sent, received;
  sent.passed.insert({1, 2, 3});
  EXPECT_TRUE(apply(change_to(sent, 0, to_messages(sent)), received));
  EXPECT_TRUE(received.passed.contains({1, 2, 3}));
  const OccupancyMap nothing;
  EXPECT_TRUE(apply(whole_change(nothing), received)) << "they are gone now";
  EXPECT_FALSE(apply(whole_change(nothing), received));
}

}  // namespace
}  // namespace voxlist
