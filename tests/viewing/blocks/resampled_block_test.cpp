#include "voxlist/viewing/blocks/resampled_block.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace voxlist::viewing {
namespace {

// Voxels of a coarser lattice that hold a centre of the map's.
std::set<Voxel> reference(const VoxelMap& map, double edge_m) {
  std::set<Voxel> voxels;
  map.for_each_voxel(
      [&](const Voxel& v) { voxels.insert(voxel_at(center(v, map.resolution_m()), edge_m)); });
  return voxels;
}

std::set<Voxel> resampled(const VoxelMap& map, double edge_m) {
  std::set<Voxel> voxels;
  for (std::int32_t z = -4; z < 4; ++z)
    for (std::int32_t y = -4; y < 4; ++y)
      for (std::int32_t x = -4; x < 4; ++x)
        VoxelMap::visit_block({x, y, z}, resampled_block(map, edge_m, {x, y, z}),
                              [&](const Voxel& v) { voxels.insert(v); });
  return voxels;
}

VoxelMap random_map(double resolution_m) {
  std::mt19937 random(1);
  VoxelMap map(resolution_m);
  for (int i = 0; i < 500; ++i) {
    const auto next = [&] { return static_cast<std::int32_t>(random() % 60) - 30; };
    map.insert({next(), next(), next()});
  }
  return map;
}

TEST(ResampledBlock, HasTheVoxelsThatHoldACentreOfTheMaps) {
  for (const double edge_m : {0.02, 0.05, 0.08, 0.2}) {
    const VoxelMap map = random_map(0.02);
    ASSERT_FALSE(reference(map, edge_m).empty());
    EXPECT_EQ(resampled(map, edge_m), reference(map, edge_m)) << edge_m;
  }
}

TEST(BlocksThatShow, HoldEveryVoxelOfTheBlock) {
  const VoxelMap map = random_map(0.02);
  for (const double edge_m : {0.05, 0.2}) {
    map.for_each_voxel([&](const Voxel& v) {
      const VoxelBox box = blocks_that_show(block_of(v), 0.02, edge_m);
      const Voxel shown = block_of(voxel_at(center(v, 0.02), edge_m));
      EXPECT_LE(box.lowest.x, shown.x);
      EXPECT_GE(box.highest.x, shown.x);
      EXPECT_LE(box.lowest.z, shown.z);
      EXPECT_GE(box.highest.z, shown.z);
    });
  }
}

}  // namespace
}  // namespace voxlist::viewing
