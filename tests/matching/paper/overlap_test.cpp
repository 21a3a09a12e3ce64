#include "voxlist/matching/paper/overlap.h"

#include <gtest/gtest.h>

#include <vector>

namespace voxlist::matching {
namespace {

VoxelMap map_of(const std::vector<Voxel>& voxels) {
  VoxelMap map;
  for (const Voxel& v : voxels) map.insert(v);
  return map;
}

TEST(Overlap, CountsTheVoxelsThatScanAndMapShare) {
  const std::vector<Voxel> scan{{0, 0, 0}, {1, 2, 3}, {-9, 4, -1}};
  EXPECT_EQ(overlap(scan, map_of(scan)), 3);
  EXPECT_EQ(overlap(scan, map_of({{1, 2, 3}, {5, 5, 5}})), 1);
}

TEST(Overlap, MovesTheScanByTheOffset) {
  const std::vector<Voxel> scan{{0, 0, 0}, {1, 0, 0}};
  const VoxelMap map = map_of({{10, -20, 30}, {11, -20, 30}, {12, -20, 30}});
  EXPECT_EQ(overlap(scan, map, {10, -20, 30}), 2);
  EXPECT_EQ(overlap(scan, map, {12, -20, 30}), 1);
  EXPECT_EQ(overlap(scan, map, {13, -20, 30}), 0);
}

TEST(Overlap, IsZeroWithNothing) {
  const std::vector<Voxel> scan{{0, 0, 0}};
  EXPECT_EQ(overlap(scan, VoxelMap()), 0);
  EXPECT_EQ(overlap({}, map_of(scan)), 0);
}

}  // namespace
}  // namespace voxlist::matching
