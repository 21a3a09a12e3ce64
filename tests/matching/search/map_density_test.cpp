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

// Points of map and scan lie beside each other, none on another. The walls stand in the middles of
// the search's cells of 0.16 m, as the search takes them to.
TEST(MapDensity, LetsAScanOverlapAMapOfFewPoints) {
  const RoomSurfaces room(6.08, 4.0, 6, 1);
  const Eigen::Vector3d half_cell(0.08, 0.08, 0.0);
  OccupancyMap map;
  room.sample(0.2, [&](const Eigen::Vector3d& p) {
    map.occupied.insert(voxel_at(p + half_cell, kFinestResolution_m));
  });
  const Pose2 truth{2.5, 1.7, 0.4};
  Cloud scan;
  room.sample(0.11, [&](const Eigen::Vector3d& p) {
    scan.points.push_back((truth.inverse() * p).cast<float>());
  });
  const Match match = make_matcher(map, {})->match(PreparedScan(scan), std::nullopt);
  ASSERT_FALSE(match.modes.empty());
  const Pose2 in_map{truth.x_m + half_cell.x(), truth.y_m + half_cell.y(), truth.yaw_rad};
  EXPECT_LT(distance_m(match.modes.front().pose, in_map), 0.05);
  EXPECT_GT(match.modes.front().overlap_ratio, 0.9);
}

}  // namespace
}  // namespace voxlist::matching
