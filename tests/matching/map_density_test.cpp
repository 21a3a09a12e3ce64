#include "matching/map_density.h"

#include <gtest/gtest.h>

namespace voxlist {
namespace {

// A wall of 6 x 3 m that has a point at every so many voxels.
VoxelMap wall(std::int32_t spacing) {
  VoxelMap map;
  for (std::int32_t x = 0; x < 300; x += spacing)
    for (std::int32_t z = 0; z < 150; z += spacing) map.insert({x, 7, z});
  return map;
}

TEST(MapDensity, GivesTheCellsThatCloseASurfaceOfPoints) {
  EXPECT_DOUBLE_EQ(closed_cell_m(wall(1)), 0.04);
  EXPECT_DOUBLE_EQ(closed_cell_m(wall(2)), 0.04);
  EXPECT_DOUBLE_EQ(closed_cell_m(wall(4)), 0.08);
  EXPECT_DOUBLE_EQ(closed_cell_m(wall(8)), 0.16);
}

TEST(MapDensity, GivesNoCellsTooLargeToTellPlacesApart) {
  EXPECT_DOUBLE_EQ(closed_cell_m(wall(50)), 0.16);
  EXPECT_DOUBLE_EQ(closed_cell_m(VoxelMap{}), 0.04);
}

}  // namespace
}  // namespace voxlist
