#include "voxlist/voxels/occupancy_list.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <set>

namespace voxlist {
namespace {

std::vector<Eigen::Vector3f> random_points(unsigned seed, int count, float extent_m) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> coordinate(-extent_m, extent_m);
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < count; ++i)
    points.emplace_back(coordinate(random), coordinate(random), coordinate(random));
  return points;
}

TEST(OccupancyList, HoldsEachOccupiedVoxelOnce) {
  const std::vector<Eigen::Vector3f> points{
      {0.001f, 0.f, 0.f}, {0.019f, 0.f, 0.f}, {-0.001f, 0.f, 0.f}};
  const auto list = OccupancyList::from_points(points, 0.02);
  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(list.voxels()[0], (Voxel{-1, 0, 0}));
  EXPECT_EQ(list.voxels()[1], (Voxel{0, 0, 0}));
}

TEST(OccupancyList, DropsPointsOutsideTheLattice) {
  const float inf = std::numeric_limits<float>::infinity(),
              nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<Eigen::Vector3f> points{
      {inf, 0.f, 0.f}, {0.f, nan, 0.f}, {1e9f, 0.f, 0.f}, {1.f, 1.f, 1.f}};
  EXPECT_EQ(OccupancyList::from_points(points).size(), 1u);
}

TEST(OccupancyList, DownSampledVoxelsAreThoseThatHoldAPoint) {
  const auto points = random_points(1, 3000, 2.f);
  const auto list = OccupancyList::from_points(points, 0.02);
  for (const int factor : {2, 4, 8, 16, 32, 64}) {
    std::set<Voxel> expected;
    for (const auto& v : list.voxels()) {
      expected.insert({static_cast<int>(std::floor(double(v.x) / factor)),
                       static_cast<int>(std::floor(double(v.y) / factor)),
                       static_cast<int>(std::floor(double(v.z) / factor))});
    }
    const auto& coarse = list.down_sampled(factor);
    EXPECT_TRUE(std::equal(expected.begin(), expected.end(), coarse.voxels().begin(),
                           coarse.voxels().end()));
    EXPECT_DOUBLE_EQ(coarse.resolution_m(), 0.02 * factor);
  }
}

TEST(OccupancyList, DownSamplingTwiceIsDownSamplingOnce) {
  const auto list = OccupancyList::from_points(random_points(2, 2000, 1.f), 0.02);
  const auto twice = list.down_sampled(4).down_sampled(8).voxels();
  const auto once = list.down_sampled(32).voxels();
  EXPECT_TRUE(std::equal(once.begin(), once.end(), twice.begin(), twice.end()));
}

TEST(OccupancyList, CachesEachFactor) {
  const auto list = OccupancyList::from_points(random_points(3, 100, 1.f));
  EXPECT_EQ(&list.down_sampled(8), &list.down_sampled(8));
  EXPECT_NE(&list.down_sampled(8), &list.down_sampled(4));
}

TEST(OccupancyList, RefusesAFactorBelowOne) {
  EXPECT_THROW(OccupancyList({}, 0.02).down_sampled(0), std::invalid_argument);
}

}  // namespace
}  // namespace voxlist
