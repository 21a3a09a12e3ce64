#include "voxlist/voxels/voxel_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

namespace voxlist {
namespace {

std::vector<Voxel> random_voxels(unsigned seed, int count, int extent) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> coordinate(-extent, extent);
  std::vector<Voxel> voxels;
  for (int i = 0; i < count; ++i)
    voxels.push_back({coordinate(random), coordinate(random), coordinate(random)});
  return voxels;
}

TEST(VoxelMap, AgreesWithAnOrderedSetOnRandomVoxels) {
  const auto voxels = random_voxels(1, 50000, 60);
  VoxelMap map;
  std::set<Voxel> reference;
  for (const auto& v : voxels) EXPECT_EQ(map.insert(v), reference.insert(v).second);
  EXPECT_EQ(map.size(), reference.size());
  for (const auto& v : random_voxels(2, 50000, 70))
    EXPECT_EQ(map.contains(v), reference.contains(v));
  std::set<Voxel> visited;
  map.for_each_voxel([&](const Voxel& v) { EXPECT_TRUE(visited.insert(v).second); });
  EXPECT_EQ(visited, reference);
}

TEST(VoxelMap, DirectoryGrowsWithFarApartBlocks) {
  VoxelMap map;
  const auto voxels = random_voxels(3, 20000, kVoxelLimit);
  for (const auto& v : voxels) map.insert(v);
  EXPECT_TRUE(
      std::all_of(voxels.begin(), voxels.end(), [&](const Voxel& v) { return map.contains(v); }));
  EXPECT_FALSE(map.contains({1, 2, 3}));
}

TEST(VoxelMap, HashDependsOnTheSetAlone) {
  auto voxels = random_voxels(4, 5000, 100);
  VoxelMap forward, backward;
  for (const auto& v : voxels) forward.insert(v);
  std::reverse(voxels.begin(), voxels.end());
  for (const auto& v : voxels) backward.insert(v);
  EXPECT_EQ(forward.hash(), backward.hash());
  backward.insert({101, 0, 0});
  EXPECT_NE(forward.hash(), backward.hash());
  EXPECT_NE(VoxelMap(0.02).hash(), VoxelMap(0.04).hash());
}

TEST(VoxelMap, BlocksCarryAMapToAnother) {
  VoxelMap map, copy;
  for (const auto& v : random_voxels(5, 5000, 50)) map.insert(v);
  for (std::size_t i = 0; i < map.block_count(); ++i)
    EXPECT_TRUE(copy.set_block(map.block_position(i), map.block(i)));
  EXPECT_EQ(copy.hash(), map.hash());
  EXPECT_EQ(copy.size(), map.size());
  EXPECT_FALSE(copy.set_block(map.block_position(0), map.block(0)));
}

TEST(VoxelMap, AMergedBlockKeepsWhatWasThere) {
  VoxelMap map, other;
  map.insert({1, 2, 3});
  map.insert({4, 2, 3});
  other.insert({4, 2, 3});
  other.insert({5, 2, 3});
  EXPECT_TRUE(map.merge_block({0, 0, 0}, other.block(0)));
  EXPECT_EQ(map.size(), 3u);
  EXPECT_TRUE(map.contains({1, 2, 3}) && map.contains({5, 2, 3}));
  EXPECT_FALSE(map.merge_block({0, 0, 0}, other.block(0)));
  EXPECT_TRUE(map.merge_block({-1, 0, 0}, other.block(0)));
  EXPECT_EQ(map.size(), 5u);
}

TEST(VoxelMap, ABlockSetEmptyLeavesNoTrace) {
  VoxelMap map;
  map.insert({1, 2, 3});
  const std::uint64_t before = map.hash();
  map.insert({100, 2, 3});
  EXPECT_TRUE(map.set_block(block_of({100, 2, 3}), VoxelBlock{}));
  EXPECT_EQ(map.size(), 1u);
  EXPECT_FALSE(map.contains({100, 2, 3}));
  EXPECT_EQ(map.hash(), before);
}

TEST(VoxelMap, FindsBlocksByPosition) {
  VoxelMap map;
  map.insert({-1, 9, 16});
  ASSERT_NE(map.find_block({-1, 1, 2}), nullptr);
  EXPECT_EQ((*map.find_block({-1, 1, 2}))[0], std::uint64_t{1} << (7 + 8 * 1));
  EXPECT_EQ(map.find_block({0, 1, 2}), nullptr);
}

TEST(VoxelMap, BoundsAreThoseOfItsBlocks) {
  VoxelMap map;
  EXPECT_EQ(map.bounds(), std::nullopt);
  map.insert({-1, 9, 16});
  EXPECT_EQ(map.bounds(), (VoxelBox{{-8, 8, 16}, {-1, 15, 23}}));
  map.insert({100, -20, 17});
  EXPECT_EQ(map.bounds(), (VoxelBox{{-8, -24, 16}, {103, 15, 23}}));
}

TEST(VoxelMap, RevisionIsAnotherOneAfterEachChangeAndOnlyThen) {
  VoxelMap map;
  std::set<std::uint64_t> seen{map.revision()};
  const auto is_new = [&] { return seen.insert(map.revision()).second; };
  EXPECT_TRUE(map.insert({1, 2, 3}) && is_new());
  EXPECT_TRUE(map.set_block({0, 0, 0}, {1}) && is_new());
  EXPECT_TRUE(map.merge_block({0, 0, 0}, {2}) && is_new());
  EXPECT_FALSE(map.insert({0, 0, 0}) || is_new());
  EXPECT_FALSE(map.set_block({0, 0, 0}, {3}) || is_new());
  EXPECT_FALSE(map.merge_block({0, 0, 0}, {1}) || is_new());
}

TEST(VoxelMap, RevisionTellsAMapFromTheOneThatTakesItsPlace) {
  VoxelMap map;
  map.insert({1, 2, 3});
  const VoxelMap before = map;
  EXPECT_EQ(map.revision(), before.revision());
  map.insert({2, 2, 3});
  const std::uint64_t changed = map.revision();
  map = before;
  EXPECT_EQ(map.revision(), before.revision()) << "it holds the same again";
  map.insert({3, 2, 3});
  EXPECT_NE(map.revision(), changed);
  map = VoxelMap(0.04);
  EXPECT_NE(map.revision(), VoxelMap(0.02).revision());
}

TEST(VoxelMap, RefusesAResolutionOfZero) { EXPECT_THROW(VoxelMap(0.0), std::invalid_argument); }

}  // namespace
}  // namespace voxlist
