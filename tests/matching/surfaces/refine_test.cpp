#include "voxlist/matching/surfaces/refine.h"

#include <gtest/gtest.h>

#include "tests/matching/synthetic_room.h"

namespace voxlist::matching {
namespace {

// A map of which nothing is known but what is occupied.
OccupancyMap occupied(const VoxelMap& map) { return {map, VoxelMap(kPassedResolution_m)}; }

// A wall across x.
void add_wall(double x, OccupancyMap& map) {
  for (double y = 0.0; y < 2.0; y += 0.02) {
    for (double z = 0.0; z < 2.0; z += 0.02)
      map.occupied.insert(voxel_at(Eigen::Vector3d(x, y, z), 0.02));
  }
}

// Rays passed between two x.
void add_free(double low, double high, OccupancyMap& map) {
  for (double x = low; x < high; x += 0.02) {
    for (double y = 0.0; y < 2.0; y += 0.08) {
      for (double z = 0.0; z < 2.0; z += 0.08)
        map.passed.insert(voxel_at(Eigen::Vector3d(x, y, z), kPassedResolution_m));
    }
  }
}

// The room's walls lie on faces of voxels, so that each stands half a voxel off in the map: 0.014 m
// over both axes.
TEST(Refine, FindsThePoseToHalfAVoxelOfTheMap) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const auto room = synthetic_room(6.0, 5.0, {2.5, 2.0, 0.7}, 5000, seed);
    const OccupancyMap map = occupied(room.map);
    const SurfelMap surfels(map);
    const Pose2 start = room.truth * Pose2{0.06, -0.05, 0.01};
    const auto refined = refine(surfels, room.scan, start);
    EXPECT_TRUE(refined.converged);
    EXPECT_LT(distance_m(refined.pose, room.truth), 0.016) << "seed " << seed;
    EXPECT_LT(turn_rad(refined.pose, room.truth), 0.002) << "seed " << seed;
    EXPECT_GT(refined.inlier_ratio, 0.5);
  }
}

TEST(Refine, SaysThatACorridorLeavesItsLongAxisOpen) {
  OccupancyMap corridor;
  std::vector<Eigen::Vector3f> scan;
  for (double x = -8.0; x < 8.0; x += 0.02) {
    for (double z = 0.0; z < 2.0; z += 0.02) {
      for (const double y : {-1.0, 1.0}) {
        corridor.occupied.insert(voxel_at(Eigen::Vector3d(x, y, z), 0.02));
        if (scan.size() < 4000 && static_cast<int>(x * 50 + z * 50) % 13 == 0) {
          scan.emplace_back(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
        }
      }
    }
  }
  const auto refined = refine(SurfelMap(corridor), scan, Pose2{0.05, 0.05, 0.0});
  EXPECT_LT(std::abs(refined.pose.y_m), 0.015);
  EXPECT_GT(refined.covariance(0, 0), 50.0 * refined.covariance(1, 1));
}

TEST(Refine, StaysAtItsStartWhereThereIsNoSurface) {
  const std::vector<Eigen::Vector3f> scan{{1.f, 0.f, 0.f}};
  const OccupancyMap nothing;
  const auto refined = refine(SurfelMap(nothing), scan, Pose2{1.0, 2.0, 3.0});
  EXPECT_EQ(distance_m(refined.pose, {1.0, 2.0, 0.0}), 0.0);
  EXPECT_NEAR(refined.pose.yaw_rad, 3.0, 1e-12);
  EXPECT_EQ(refined.inlier_ratio, 0.0);
}

TEST(SurfelMap, FitsTheWallThatAPointLiesOn) {
  OccupancyMap map;
  add_wall(1.01, map);
  const SurfelMap surfels(map);
  const Surfel* surfel = surfels.find({1.1, 1.0, 1.0}, {0.0, 1.0, 1.0});
  ASSERT_NE(surfel, nullptr);
  EXPECT_NEAR(std::abs(surfel->normal.x()), 1.0, 1e-9);
  EXPECT_NEAR(surfel->mean.x(), 1.01, 1e-9);
  EXPECT_EQ(surfels.find({3.0, 1.0, 1.0}, {0.0, 1.0, 1.0}), nullptr);
}

TEST(SurfelMap, GivesEachRayTheFaceOfAThinWallThatItCouldSee) {
  int found = 0;
  for (const double thickness_m : {0.08, 0.1, 0.12, 0.15}) {
    for (const double at_m : {0.97, 1.05, 1.1, 1.19, 1.27}) {
      OccupancyMap map;
      add_wall(at_m, map);
      add_wall(at_m + thickness_m, map);
      add_free(0.3, at_m - 0.02, map);
      add_free(at_m + thickness_m + 0.02, 2.0, map);
      const SurfelMap surfels(map);
      const double faces_m[] = {at_m, at_m + thickness_m}, origins_m[] = {0.0, 3.0};
      for (int i = 0; i < 2; ++i) {
        const Surfel* surfel = surfels.find({faces_m[i], 1.0, 1.0}, {origins_m[i], 1.0, 1.0});
        if (!surfel) continue;  // the face is in another cube than this point
        ++found;
        EXPECT_NEAR(surfel->mean.x(), faces_m[i], 0.0101) << thickness_m << " at " << at_m;
        EXPECT_EQ(surfel->two_sided, false);
      }
    }
  }
  EXPECT_GE(found, 30) << "of 40";
}

TEST(SurfelMap, HidesAWallFromRaysThatWouldHaveToComeThroughIt) {
  OccupancyMap map;
  add_wall(1.01, map);
  add_free(0.3, 1.0, map);
  const SurfelMap surfels(map);
  ASSERT_NE(surfels.find({1.01, 1.0, 1.0}, {0.0, 1.0, 1.0}), nullptr);
  EXPECT_LT(surfels.find({1.01, 1.0, 1.0}, {0.0, 1.0, 1.0})->normal.x(), -0.99);
  EXPECT_EQ(surfels.find({1.01, 1.0, 1.0}, {2.0, 1.0, 1.0}), nullptr);
}

TEST(SurfelMap, KnowsWhatAChangeBrought) {
  OccupancyMap map;
  SurfelMap surfels(map);
  const Eigen::Vector3d point(1.01, 1.0, 1.0), origin(0.0, 1.0, 1.0);
  EXPECT_EQ(surfels.find(point, origin), nullptr);
  add_wall(1.01, map);
  surfels.map_changed();
  EXPECT_NE(surfels.find(point, origin), nullptr);
}

}  // namespace
}  // namespace voxlist::matching
