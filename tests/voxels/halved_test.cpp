#include "voxlist/voxels/halved.h"

#include <gtest/gtest.h>

#include <random>

namespace voxlist {
namespace {

VoxelBlock block_of_some(std::mt19937& random) {
  VoxelBlock block{};
  for (std::uint64_t& word : block)
    if (random() % 2 == 0) word = std::uint64_t{1} << random() % 64 | std::uint64_t{random()} << 32;
  return block;
}

TEST(HalvedBlock, IsOccupiedWhereAnyOfEightVoxelsIs) {
  std::mt19937 random(3);
  for (int round = 0; round < 50; ++round) {
    const VoxelBlock block = block_of_some(random);
    VoxelMap expected;
    VoxelMap::visit_block({0, 0, 0}, block, [&](const Voxel& v) {
      expected.insert({v.x / 2, v.y / 2, v.z / 2});
    });
    VoxelMap half;
    half.set_block({0, 0, 0}, halved_block(block));
    ASSERT_GT(half.size(), 0u);
    EXPECT_EQ(half.hash(), expected.hash());
  }
}

TEST(HalvedBlock, ThreeTimesIsOneVoxel) {
  VoxelBlock corner{};
  corner[7] = std::uint64_t{1} << 63;
  EXPECT_EQ(halved_block(halved_block(halved_block(corner))), VoxelBlock{1});
  EXPECT_EQ(halved_block({}), VoxelBlock{});
}

TEST(Halved, HoldsTheVoxelsOfTwiceTheEdgeThatHoldOneOfTheMap) {
  std::mt19937 random(1);
  std::uniform_int_distribution<std::int32_t> coordinate(-40, 40);
  VoxelMap map(0.05), expected(0.1);
  for (int i = 0; i < 3000; ++i) {
    const Voxel v{coordinate(random), coordinate(random), coordinate(random)};
    map.insert(v);
    expected.insert({floor_div(v.x, 2), floor_div(v.y, 2), floor_div(v.z, 2)});
  }
  const VoxelMap result = halved(map);
  EXPECT_EQ(result.size(), expected.size());
  EXPECT_EQ(result.hash(), expected.hash());
}

TEST(Halved, OfNothingIsNothing) { EXPECT_TRUE(halved(VoxelMap(0.02)).empty()); }

}  // namespace
}  // namespace voxlist
