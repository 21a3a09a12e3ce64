#include "voxlist/matching/search/map_density.h"

#include <gtest/gtest.h>

#include "tests/matching/synthetic_room.h"
#include "voxlist/matching/engines/matcher.h"

namespace voxlist::matching {
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

// Points of map and scan lie beside each other, none on another.
TEST(MapDensity, LetsAScanOverlapAMapOfFewPoints) {
  const RoomSurfaces room(6.0, 4.0, 6, 1);
  OccupancyMap map;
  room.sample(0.2, [&](const Eigen::Vector3d& p) {
    map.occupied.insert(voxel_at(p, kFinestResolution_m));
  });
  const Pose2 truth{2.5, 1.7, 0.4};
  Cloud scan;
  room.sample(0.11, [&](const Eigen::Vector3d& p) {
    scan.points.push_back((truth.inverse() * p).cast<float>());
  });
  const Match match = make_matcher(map, {})->match(scan, std::nullopt);
  ASSERT_FALSE(match.modes.empty());
  EXPECT_LT(distance_m(match.modes.front().pose, truth), 0.05);
  EXPECT_GT(match.modes.front().overlap, 0.9);
}

}  // namespace
}  // namespace voxlist::matching
