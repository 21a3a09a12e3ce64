#include "bus/map_convert.h"

#include <gtest/gtest.h>

#include <random>

namespace voxlist {
namespace {

TEST(MapConvert, AWholeMapAndItsIncrementsCarryTheMapOver) {
  std::mt19937 random(1);
  std::uniform_int_distribution<int> coordinate(-200, 200);
  VoxelMap sent, received(0.5);
  for (int i = 0; i < 5000; ++i)
    sent.insert({coordinate(random), coordinate(random), coordinate(random)});
  MapChange whole{.resolution_m = sent.resolution_m(), .blocks = to_messages(sent)};
  EXPECT_TRUE(apply(whole, received));
  EXPECT_EQ(received.hash(), sent.hash());

  sent.insert({1000, -1000, 7});
  MapChange increment = whole;
  increment.version = 1;
  increment.base_version = 0;
  increment.blocks = to_messages(sent, {block_of({1000, -1000, 7}), {9999, 9999, 9999}});
  EXPECT_EQ(increment.blocks.size(), 1u);
  EXPECT_TRUE(apply(increment, received));
  EXPECT_EQ(received.hash(), sent.hash());
  EXPECT_FALSE(apply(increment, received));
}

}  // namespace
}  // namespace voxlist
