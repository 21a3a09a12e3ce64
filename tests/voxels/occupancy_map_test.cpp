#include "voxlist/voxels/occupancy_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <set>

#include "voxlist/voxels/voxel_ray.h"

namespace voxlist {
namespace {

constexpr double kRange_m = 20.0;

Voxel passed_cell(double x_m, double y_m, double z_m) {
  return voxel_at(Eigen::Vector3d(x_m, y_m, z_m), kPassedResolution_m);
}

Cloud random_cloud(std::uint32_t seed, int points) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> coordinate(-9.f, 9.f), offset(-0.3f, 0.3f);
  Cloud cloud;
  for (int i = 0; i < points; ++i) {
    cloud.points.push_back({coordinate(random), coordinate(random), coordinate(random) / 4});
    cloud.origins.push_back({offset(random), offset(random), offset(random)});
  }
  return cloud;
}

const Pose3 kPose = to_pose3({3.0, -40.0, 2.5});

// What add_scan says in words, one cell at a time.
OccupancyMap slowly(const Cloud& cloud, const Pose3& T_map_base, OccupancyMap map) {
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const Eigen::Vector3d to = T_map_base * cloud.points[i].cast<double>();
    const Eigen::Vector3d from = T_map_base * cloud.origin(i).cast<double>();
    map.occupied.insert(voxel_at(to, map.occupied.resolution_m()));
    const double passed_m = map.passed.resolution_m();
    visit_ray(from, to, passed_m, [&](const Voxel& cell) {
      if (cell != voxel_at(to, passed_m)) map.passed.insert(cell);
      return true;
    });
  }
  return map;
}

std::vector<Voxel> differing_blocks(const VoxelMap& before, const VoxelMap& after) {
  std::set<Voxel> blocks;
  for (std::size_t i = 0; i < after.block_count(); ++i) {
    const VoxelBlock* old = before.find_block(after.block_position(i));
    if ((old ? *old : VoxelBlock{}) != after.block(i)) blocks.insert(after.block_position(i));
  }
  return {blocks.begin(), blocks.end()};
}

TEST(OccupancyMap, GetsWhatASlowReferenceSaysAndNamesTheBlocksThatDiffer) {
  OccupancyMap map;
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    const Cloud cloud = random_cloud(seed, 500);
    const OccupancyMap before = map, expected = slowly(cloud, kPose, map);
    const ChangedBlocks changed = add_scan(cloud, kPose, kRange_m, map);
    EXPECT_EQ(map.occupied.hash(), expected.occupied.hash()) << "seed " << seed;
    EXPECT_EQ(map.passed.hash(), expected.passed.hash()) << "seed " << seed;
    EXPECT_EQ(changed.occupied, differing_blocks(before.occupied, map.occupied));
    EXPECT_EQ(changed.passed, differing_blocks(before.passed, map.passed));
    EXPECT_GT(changed.passed.size(), 100u);
  }
}

TEST(OccupancyMap, DoesNotDependOnTheOrderOfPoints) {
  const Cloud cloud = random_cloud(7, 1000);
  std::vector<std::size_t> order(cloud.points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::shuffle(order.begin(), order.end(), std::mt19937(8));
  Cloud shuffled;
  for (const std::size_t i : order) {
    shuffled.points.push_back(cloud.points[i]);
    shuffled.origins.push_back(cloud.origins[i]);
  }
  OccupancyMap a, b;
  const ChangedBlocks in_a = add_scan(cloud, kPose, kRange_m, a);
  const ChangedBlocks in_b = add_scan(shuffled, kPose, kRange_m, b);
  EXPECT_EQ(a.occupied.hash(), b.occupied.hash());
  EXPECT_EQ(a.passed.hash(), b.passed.hash());
  EXPECT_EQ(in_a.occupied, in_b.occupied);
  EXPECT_EQ(in_a.passed, in_b.passed);
}

TEST(OccupancyMap, ChangesNothingWhenItSeesAScanAgain) {
  OccupancyMap map;
  const Cloud cloud = random_cloud(9, 300);
  add_scan(cloud, kPose, kRange_m, map);
  const ChangedBlocks again = add_scan(cloud, kPose, kRange_m, map);
  EXPECT_TRUE(again.occupied.empty());
  EXPECT_TRUE(again.passed.empty());
}

TEST(OccupancyMap, ARayPassesAllButTheCellItEndsIn) {
  OccupancyMap map;
  Cloud cloud;
  cloud.points = {{1.01f, 0.01f, 0.01f}};
  add_scan(cloud, Pose3::Identity(), kRange_m, map);
  EXPECT_EQ(map.passed.size(), 12u);
  for (int x = 0; x < 12; ++x) EXPECT_TRUE(map.passed.contains({x, 0, 0})) << x;
  EXPECT_FALSE(map.passed.contains(passed_cell(1.01, 0.01, 0.01)));
  EXPECT_EQ(map.occupied.size(), 1u);
  EXPECT_TRUE(map.occupied.contains({50, 0, 0}));
}

TEST(OccupancyMap, RaysStartWhereTheirOriginsAre) {
  OccupancyMap map;
  Cloud cloud;
  cloud.points = {{1.01f, 2.01f, 0.01f}};
  cloud.origins = {{1.01f, 1.01f, 0.01f}};
  add_scan(cloud, to_pose3({0.0, -1.0, 0.0}), kRange_m, map);
  EXPECT_TRUE(map.passed.contains(passed_cell(1.01, 0.01, 0.01)));
  EXPECT_TRUE(map.passed.contains(passed_cell(1.01, 0.5, 0.01)));
  EXPECT_FALSE(map.passed.contains(passed_cell(1.01, -0.1, 0.01)));
  EXPECT_EQ(map.passed.size(), 12u);
}

TEST(OccupancyMap, LeavesOutFarPointsRayAndAll) {
  OccupancyMap map;
  Cloud cloud;
  cloud.points = {{6.f, 0.f, 0.f}, {6.f, 1.f, 0.f}};
  cloud.origins = {{0.f, 0.f, 0.f}, {5.f, 1.f, 0.f}};
  add_scan(cloud, Pose3::Identity(), 5.0, map);
  EXPECT_EQ(map.occupied.size(), 1u);
  EXPECT_FALSE(map.passed.contains(passed_cell(1.0, 0.0, 0.0)));
  EXPECT_TRUE(map.passed.contains(passed_cell(5.5, 1.0, 0.0)));
}

TEST(OccupancyMap, LeavesOutWhatLiesOutsideTheLattice) {
  OccupancyMap map;
  const float far_m = static_cast<float>(1.001 * kVoxelLimit * kFinestResolution_m);
  Cloud cloud;
  cloud.points = {{far_m, 0.f, 0.f}, {1.f, 0.f, 0.f}};
  cloud.origins = {{far_m - 1.f, 0.f, 0.f}, {1.f, far_m, 0.f}};
  const ChangedBlocks changed = add_scan(cloud, Pose3::Identity(), 1e9, map);
  EXPECT_TRUE(map.empty());
  EXPECT_TRUE(map.passed.empty());
  EXPECT_TRUE(changed.occupied.empty());
}

// More tiles than a scan may hold at once: they move to the map before its end.
TEST(OccupancyMap, TakesAScanThatReachesFarAllRound) {
  Cloud cloud;
  std::mt19937 random(11);
  std::normal_distribution<float> axis;
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector3f way(axis(random), axis(random), axis(random));
    cloud.points.push_back(way.normalized() * 90.f);
  }
  OccupancyMap map;
  const ChangedBlocks changed = add_scan(cloud, kPose, 100.0, map);
  const OccupancyMap expected = slowly(cloud, kPose, {});
  EXPECT_EQ(map.passed.hash(), expected.passed.hash());
  EXPECT_EQ(changed.passed, differing_blocks(VoxelMap(), map.passed));
}

}  // namespace
}  // namespace voxlist
