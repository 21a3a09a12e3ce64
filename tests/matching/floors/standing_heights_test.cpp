#include "voxlist/matching/floors/standing_heights.h"

#include <gtest/gtest.h>

namespace voxlist::matching {
namespace {

// A level surface of 4 m by 4 m that rays from above have ended on.
void add_surface(double height_m, double edge_m, OccupancyMap& map) {
  Cloud cloud;
  for (double x = -edge_m / 2.0; x < edge_m / 2.0; x += 0.04)
    for (double y = -edge_m / 2.0; y < edge_m / 2.0; y += 0.04) {
      cloud.points.push_back(Eigen::Vector3d(x, y, height_m).cast<float>());
      cloud.origins.push_back(Eigen::Vector3d(x, y, height_m + 1.0).cast<float>());
    }
  add_scan(cloud, Pose3::Identity(), 100.0, map);
}

TEST(StandingHeights, AreTheFloorsTheLargestFirst) {
  OccupancyMap map;
  add_surface(3.0, 3.0, map);
  add_surface(0.0, 4.0, map);
  const std::vector<double> heights = standing_heights(map);
  ASSERT_EQ(heights.size(), 2U);
  EXPECT_NEAR(heights[0], 0.0, 0.03);
  EXPECT_NEAR(heights[1], 3.0, 0.03);
}

TEST(StandingHeights, AreNoTablesAndNoCeilings) {
  OccupancyMap map;
  add_surface(0.0, 4.0, map);
  add_surface(0.7, 0.9, map);
  for (double x = -2.0; x < 2.0; x += 0.02)
    for (double y = -2.0; y < 2.0; y += 0.02)
      map.occupied.insert(voxel_at(Eigen::Vector3d(x, y, 2.6), map.occupied.resolution_m()));
  ASSERT_EQ(standing_heights(map).size(), 1U);
}

TEST(StandingHeights, AboutAPlaceAreThoseOfTheFloorsThere) {
  OccupancyMap map;
  add_surface(0.0, 12.0, map);
  add_surface(3.0, 4.0, map);
  const std::vector<double> heights = standing_heights_about(map, {1.0, 0.0, 0.0});
  ASSERT_EQ(heights.size(), 2U);
  EXPECT_NEAR(heights[0], 0.0, 0.05);
  EXPECT_NEAR(heights[1], 3.0, 0.05);
  EXPECT_EQ(standing_heights_about(map, {5.9, 0.0, 3.0}).size(), 1U);
}

TEST(StandingHeights, NothingHasNone) { EXPECT_TRUE(standing_heights({}).empty()); }

}  // namespace
}  // namespace voxlist::matching
