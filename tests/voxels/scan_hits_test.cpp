#include "voxlist/voxels/scan_hits.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace voxlist {
namespace {

TEST(ScanHits, PutTheVoxelsIntoTheMapAndNameTheBlocks) {
  std::mt19937 random(1);
  std::uniform_int_distribution<int> coordinate(-100, 100);
  VoxelMap map, expected;
  std::set<Voxel> blocks;
  ScanHits hits;
  for (int i = 0; i < 5'000; ++i) {
    const Voxel first{coordinate(random), coordinate(random), coordinate(random)};
    for (const Voxel& voxel : {first, Voxel{first.x + 1, first.y, first.z}}) {
      hits.mark(voxel);
      expected.insert(voxel);
      blocks.insert(block_of(voxel));
    }
  }
  EXPECT_EQ(hits.put_into(map), std::vector<Voxel>(blocks.begin(), blocks.end()));
  EXPECT_EQ(map.hash(), expected.hash());
  EXPECT_EQ(map.size(), expected.size());
}

TEST(ScanHits, NameNoBlockThatHadThemAll) {
  VoxelMap map;
  for (const Voxel& voxel : {Voxel{1, 1, 1}, Voxel{2, 1, 1}, Voxel{-20, 1, 1}}) map.insert(voxel);
  ScanHits hits;
  for (const Voxel& voxel : {Voxel{2, 1, 1}, Voxel{-20, 1, 1}, Voxel{-21, 1, 1}}) hits.mark(voxel);
  EXPECT_EQ(hits.put_into(map), (std::vector<Voxel>{block_of({-21, 1, 1})}));
  EXPECT_EQ(map.size(), 4u) << "what the map had stays";
}

}  // namespace
}  // namespace voxlist
