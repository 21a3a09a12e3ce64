#include "matching/refine.h"

#include <gtest/gtest.h>

#include "matching/match_points.h"
#include "synthetic_room.h"

namespace voxlist {
namespace {

// The room's walls lie on faces of voxels, so that each stands half a voxel off in the map: 0.014 m
// over both axes.
TEST(Refine, FindsThePoseToHalfAVoxelOfTheMap) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const auto room = synthetic_room(6.0, 5.0, {2.5, 2.0, 0.7}, 5000, seed);
    const SurfelMap surfels(room.map);
    const Pose2 start = room.truth * Pose2{0.06, -0.05, 0.01};
    const auto refined = refine(surfels, room.scan, start);
    EXPECT_TRUE(refined.converged);
    EXPECT_LT(distance_m(refined.pose, room.truth), 0.016) << "seed " << seed;
    EXPECT_LT(turn_rad(refined.pose, room.truth), 0.002) << "seed " << seed;
    EXPECT_GT(refined.inlier_share, 0.5);
  }
}

TEST(Refine, SaysThatACorridorLeavesItsLongAxisOpen) {
  VoxelMap corridor;
  std::vector<Eigen::Vector3f> scan;
  for (double x = -8.0; x < 8.0; x += 0.02) {
    for (double z = 0.0; z < 2.0; z += 0.02) {
      for (const double y : {-1.0, 1.0}) {
        corridor.insert(voxel_at(Eigen::Vector3d(x, y, z), 0.02));
        if (scan.size() < 4000 && static_cast<int>(x * 50 + z * 50) % 13 == 0) {
          scan.emplace_back(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
        }
      }
    }
  }
  const auto refined = refine(SurfelMap(corridor), scan, {0.05, 0.05, 0.0});
  EXPECT_LT(std::abs(refined.pose.y_m), 0.015);
  EXPECT_GT(refined.covariance(0, 0), 50.0 * refined.covariance(1, 1));
}

TEST(Refine, StaysAtItsStartWhereThereIsNoSurface) {
  const std::vector<Eigen::Vector3f> scan{{1.f, 0.f, 0.f}};
  const auto refined = refine(SurfelMap(VoxelMap()), scan, {1.0, 2.0, 3.0});
  EXPECT_EQ(refined.pose, (Pose2{1.0, 2.0, 3.0}));
  EXPECT_EQ(refined.inlier_share, 0.0);
}

TEST(SurfelMap, FitsTheWallThatAPointLiesOn) {
  VoxelMap map;
  for (double y = 0.0; y < 2.0; y += 0.02) {
    for (double z = 0.0; z < 2.0; z += 0.02)
      map.insert(voxel_at(Eigen::Vector3d(1.01, y, z), 0.02));
  }
  const SurfelMap surfels(map);
  const Surfel* surfel = surfels.find({1.1, 1.0, 1.0});
  ASSERT_NE(surfel, nullptr);
  EXPECT_NEAR(std::abs(surfel->normal.x()), 1.0, 1e-9);
  EXPECT_NEAR(surfel->mean.x(), 1.01, 1e-9);
  EXPECT_EQ(surfels.find({3.0, 1.0, 1.0}), nullptr);
}

TEST(MatchPoints, LeaveOutTheFloorAndKeepTheWalls) {
  std::vector<Eigen::Vector3f> points;
  for (float x = -4.f; x < 4.f; x += 0.05f) {
    for (float y = -4.f; y < 4.f; y += 0.05f) points.emplace_back(x, y, 0.01f);
    for (float z = 0.1f; z < 2.f; z += 0.05f) points.emplace_back(x, 4.f, z);
  }
  const auto chosen = choose_match_points(points, {});
  const auto on_floor = std::count_if(chosen.points.begin(), chosen.points.end(),
                                      [](auto& p) { return p.z() < 0.05f; });
  EXPECT_LT(on_floor, static_cast<std::ptrdiff_t>(chosen.points.size() / 10));
  EXPECT_GT(chosen.points.size(), 200u);
}

TEST(MatchPoints, DoNotDependOnTheOrderOfTheScan) {
  auto points = synthetic_room(6.0, 5.0, {2.5, 2.0, 0.7}, 5000, 1).scan;
  const auto chosen = choose_match_points(points, {.max_points = 500});
  std::reverse(points.begin(), points.end());
  const auto again = choose_match_points(points, {.max_points = 500});
  EXPECT_EQ(chosen.points, again.points);
  EXPECT_LE(chosen.points.size(), 500u);
  EXPECT_EQ(chosen.radius_m, again.radius_m);
}

TEST(MatchPoints, OfNothingAreNone) {
  EXPECT_TRUE(choose_match_points({}, {}).points.empty());
  const std::vector<Eigen::Vector3f> far{{1000.f, 0.f, 0.f}};
  EXPECT_TRUE(choose_match_points(far, {}).points.empty());
}

}  // namespace
}  // namespace voxlist
