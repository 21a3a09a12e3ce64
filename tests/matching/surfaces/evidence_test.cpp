#include "voxlist/matching/surfaces/evidence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "voxlist/matching/scan/prepared_scan.h"
#include "voxlist/simulation/building/building.h"
#include "voxlist/simulation/scanner/ideal_sweep.h"

namespace voxlist::matching {
namespace {

// A wall at x = 2 m, 4 m wide and as thick as noise makes it, and the free space before it.
OccupancyMap wall_ahead() {
  OccupancyMap map;
  Cloud cloud;
  for (float y = -2.0F; y < 2.0F; y += 0.015F)
    for (float z = 0.5F; z < 1.5F; z += 0.015F) {
      const float noise = 0.02F * static_cast<float>(cloud.points.size() % 3) - 0.02F;
      cloud.points.emplace_back(2.0F + noise, y, z);
    }
  cloud.origins.assign(cloud.points.size(), {0.0F, 0.0F, 1.0F});
  add_scan(cloud, Pose3::Identity(), 100.0, map);
  return map;
}

Evidence of_ray(const OccupancyMap& map, const Eigen::Vector3f& from, const Eigen::Vector3f& to) {
  return EvidenceMap(map).at({}, std::vector{ScanRay{from, to}});
}

TEST(Evidence, TellsHitsFromShortReturnsAndFromTheUnknown) {
  const OccupancyMap map = wall_ahead();
  const Eigen::Vector3f from(0.0F, 0.0F, 1.0F);
  EXPECT_EQ(of_ray(map, from, {2.03F, 0.1F, 1.0F}), (Evidence{1, 1, 0, 0, 1, 0}));
  EXPECT_EQ(of_ray(map, from, {1.2F, 0.1F, 1.0F}), (Evidence{1, 0, 1, 0, 1, 0}));
  EXPECT_EQ(of_ray(map, from, {-1.2F, 0.1F, 1.0F}), (Evidence{1, 0, 0, 1, 1, 0}));
}

TEST(Evidence, CallsARayThroughAWallAViolation) {
  const OccupancyMap map = wall_ahead();
  EXPECT_EQ(of_ray(map, {0.0F, 0.0F, 1.0F}, {4.0F, 0.1F, 1.0F}).violations, 1);
  // A ray says nothing about the wall that it ends on, nor about one beyond its end.
  EXPECT_EQ(of_ray(map, {0.0F, 0.0F, 1.0F}, {2.0F, 0.1F, 1.0F}).violations, 0);
  EXPECT_EQ(of_ray(map, {0.0F, 0.0F, 1.0F}, {1.0F, 0.1F, 1.0F}).violations, 0);
}

TEST(Evidence, LetsRaysGrazeAWallThatTheyEndOn) {
  const OccupancyMap map = wall_ahead();
  EXPECT_EQ(of_ray(map, {1.9F, -1.9F, 1.0F}, {2.0F, 1.9F, 1.0F}).violations, 0);
}

TEST(Evidence, MovesRaysToThePose) {
  const OccupancyMap map = wall_ahead();
  const std::vector<ScanRay> rays{{{0.0F, 0.0F, 1.0F}, {0.0F, 1.0F, 1.0F}}};
  EXPECT_EQ(EvidenceMap(map).at({1.0, 0.3, -M_PI_2}, rays).hits, 1);
  EXPECT_EQ(EvidenceMap(map).at({1.0, 0.3, M_PI_2}, rays).hits, 0);
}

TEST(Evidence, KnowsNothingInAnEmptyMap) {
  EXPECT_EQ(of_ray({}, {0.0F, 0.0F, 1.0F}, {4.0F, 0.1F, 1.0F}), (Evidence{1, 0, 0, 1, 1, 0}));
}

TEST(Evidence, IsBoundedForRaysOfAnyLengthInMapsOfAnySize) {
  OccupancyMap map = wall_ahead();
  map.occupied.insert({kVoxelLimit, -kVoxelLimit, kVoxelLimit});
  EXPECT_EQ(of_ray(map, {0.0F, 0.0F, 1.0F}, {8e4F, 10.0F, 1.0F}).violations, 1);
  EXPECT_EQ(of_ray(map, {0.0F, 0.0F, 1.0F}, {4e4F, 8e4F, 1.0F}).violations, 0);
  EXPECT_EQ(of_ray(map, {0.0F, 0.0F, 1.0F}, {1e20F, 0.0F, 1.0F}).points, 0);
}

Cloud scan_at(const simulation::Building& building, const Pose2& pose) {
  const simulation::World world(building, {});
  const simulation::Trajectory still(1.0, {pose});
  return simulation::scan_sweep(simulation::MirrorScanner(world, still, {}, 1), still, 1.0, {}, 1);
}

TEST(Evidence, HasNearlyNoViolationsAtTruePosesAndManyAtWrongOnes) {
  simulation::BuildingConfig config;
  config.seed = 3;
  const simulation::Building building = simulation::make_building(config);
  OccupancyMap map;
  for (double x = 0.0; x < 14.0; x += 1.0) {
    const Pose2 pose{x, 0.3 * std::sin(x), x};
    add_scan(scan_at(building, pose), to_pose3(pose), 100.0, map);
  }
  for (const simulation::Room& room : building.rooms) {
    const Pose2 pose{room.centre().x(), room.centre().y(), 0.3};
    add_scan(scan_at(building, pose), to_pose3(pose), 100.0, map);
  }
  const EvidenceMap evidence(map);
  for (double x = 0.5; x < 13.0; x += 3.0) {
    const Pose2 pose{x, -0.2, 2.0 * x};
    const Cloud cloud = scan_at(building, pose);
    const PreparedScan scan(cloud);
    const auto& rays = scan.few_rays();
    const Evidence right = evidence.at(pose, rays);
    EXPECT_GT(right.hits, 0.8 * right.points);
    EXPECT_LT(right.misses, 0.07 * right.points);
    EXPECT_LT(right.violations, 0.05 * right.rays);
    const Evidence wrong = evidence.at(pose * Pose2{0.0, 0.0, 1.0}, rays);
    EXPECT_LT(wrong.hits, 0.7 * wrong.points);
    EXPECT_GT(wrong.violations, 0.15 * wrong.rays);
  }
}

}  // namespace
}  // namespace voxlist::matching
