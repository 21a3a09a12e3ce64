#include "voxlist/voxels/scan_cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

namespace voxlist {
namespace {

std::vector<Voxel> random_cells(std::uint32_t seed, int count, int extent) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> coordinate(-extent, extent);
  std::vector<Voxel> cells;
  for (int i = 0; i < count; ++i)
    cells.push_back({coordinate(random), coordinate(random), coordinate(random)});
  return cells;
}

TEST(ScanCells, PutTheCellsIntoTheMapAndNameTheBlocks) {
  const auto cells = random_cells(1, 20'000, 150);
  VoxelMap map, expected;
  std::set<Voxel> blocks;
  ScanCells marked;
  for (const Voxel& cell : cells) {
    marked.mark(cell);
    expected.insert(cell);
    blocks.insert(block_of(cell));
  }
  std::vector<Voxel> changed;
  marked.move_to(map, changed);
  EXPECT_EQ(map.hash(), expected.hash());
  EXPECT_EQ(map.size(), expected.size());
  std::sort(changed.begin(), changed.end());
  EXPECT_EQ(changed, std::vector<Voxel>(blocks.begin(), blocks.end()));
}

TEST(ScanCells, NameNoBlockThatHadThemAll) {
  VoxelMap map;
  map.insert({1, 1, 1});
  map.insert({2, 1, 1});
  map.insert({-20, 1, 1});
  ScanCells marked;
  for (const Voxel& cell : {Voxel{2, 1, 1}, Voxel{-20, 1, 1}, Voxel{-21, 1, 1}}) marked.mark(cell);
  std::vector<Voxel> changed;
  marked.move_to(map, changed);
  EXPECT_EQ(changed, (std::vector<Voxel>{block_of({-21, 1, 1})}));
  EXPECT_EQ(map.size(), 4u) << "what the map had stays";
}

TEST(ScanCells, AreNoneAfterTheirMove) {
  ScanCells marked;
  marked.mark({5, 5, 5});
  EXPECT_GT(marked.memory_bytes(), 0u);
  VoxelMap first, second;
  std::vector<Voxel> changed;
  marked.move_to(first, changed);
  EXPECT_EQ(marked.memory_bytes(), 0u);
  marked.mark({6, 5, 5});
  marked.move_to(second, changed);
  EXPECT_FALSE(second.contains({5, 5, 5}));
  EXPECT_TRUE(second.contains({6, 5, 5}));
}

}  // namespace
}  // namespace voxlist
