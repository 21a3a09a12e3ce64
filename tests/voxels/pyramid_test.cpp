#include "voxels/pyramid.h"

#include <gtest/gtest.h>

#include <random>

namespace voxlist {
namespace {

VoxelMap random_map(unsigned seed, int count, int extent) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> coordinate(-extent, extent);
  VoxelMap map;
  for (int i = 0; i < count; ++i)
    map.insert({coordinate(random), coordinate(random), coordinate(random) / 4});
  return map;
}

bool holds_voxel(const VoxelMap& map, const Voxel& cell, int factor) {
  for (int x = 0; x < factor; ++x)
    for (int y = 0; y < factor; ++y)
      for (int z = 0; z < factor; ++z)
        if (map.contains({cell.x * factor + x, cell.y * factor + y, cell.z * factor + z}))
          return true;
  return false;
}

TEST(Pyramid, LevelZeroIsTheMapAndItsFaceNeighbours) {
  const VoxelMap map = random_map(1, 60, 60);
  const Pyramid pyramid(map);
  for (int x = -20; x <= 20; ++x)
    for (int y = -20; y <= 20; ++y)
      for (int z = -7; z <= 7; ++z) {
        const bool expected =
            holds_voxel(map, {x, y, z}, 4) || holds_voxel(map, {x - 1, y, z}, 4) ||
            holds_voxel(map, {x + 1, y, z}, 4) || holds_voxel(map, {x, y - 1, z}, 4) ||
            holds_voxel(map, {x, y + 1, z}, 4) || holds_voxel(map, {x, y, z - 1}, 4) ||
            holds_voxel(map, {x, y, z + 1}, 4);
        ASSERT_EQ(pyramid.level(0).test({x, y, z}), expected) << x << ' ' << y << ' ' << z;
      }
}

TEST(Pyramid, EachLevelIsTheOrOfItsWindowInLevelZero) {
  const Pyramid pyramid(random_map(2, 12, 80));
  for (int k = 1; k <= pyramid.top(); ++k) {
    const int h = 1 << (k - 1), reach = 25 + 4 * h;
    for (int x = -reach; x <= reach; x += 3)
      for (int y = -reach; y <= reach; y += 3)
        for (int z = -7; z <= 7; ++z) {
          bool expected = false;
          for (int dx = -h; dx < 3 * h && !expected; ++dx)
            for (int dy = -h; dy < 3 * h && !expected; ++dy)
              expected = pyramid.level(0).test({x + dx, y + dy, z});
          ASSERT_EQ(pyramid.level(k).test({x, y, z}), expected)
              << "level " << k << ": " << x << ' ' << y << ' ' << z;
        }
  }
}

TEST(Pyramid, CoarsensUntilAWideMapFitsItsBudget) {
  VoxelMap map;
  map.insert({0, 0, 0});
  map.insert({100000, 100000, 0});
  const Pyramid pyramid(map, {.resolution_m = 0.08, .levels = 2, .max_cells = 1e6});
  EXPECT_GE(pyramid.resolution_m(), 1.28);
  EXPECT_TRUE(
      pyramid.level(0).test(voxel_at(center({100000, 100000, 0}, 0.02), pyramid.resolution_m())));
}

TEST(Pyramid, OfAnEmptyMapIsEmpty) { EXPECT_FALSE(Pyramid(VoxelMap()).level(0).test({0, 0, 0})); }

TEST(BitGrid, ReadsAnyRunOfARow) {
  const std::uint64_t row[] = {0x8000000000000001u, 0x3u};
  EXPECT_EQ(bits_at(row, 2, 0), row[0]);
  EXPECT_EQ(bits_at(row, 2, 63), 0x7u);
  EXPECT_EQ(bits_at(row, 2, -1), 0x2u);
  EXPECT_EQ(bits_at(row, 2, 200), 0u);
}

}  // namespace
}  // namespace voxlist
