#include "voxlist/voxels/halved.h"

#include <gtest/gtest.h>

#include <random>

namespace voxlist {
namespace {

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
