#include "voxlist/voxels/scan_news.h"

#include <gtest/gtest.h>

#include <random>

#include "voxlist/voxels/voxel_ray.h"

namespace voxlist {
namespace {

constexpr double kRange_m = 20.0;

Cloud random_cloud(std::uint32_t seed, int points) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> coordinate(-4.f, 4.f);
  Cloud cloud;
  for (int i = 0; i < points; ++i)
    cloud.points.push_back({coordinate(random), coordinate(random), coordinate(random) / 4});
  return cloud;
}

// What a scan of one ray along x says, from the origin to x_m.
Cloud ray_to(float x_m) {
  Cloud cloud;
  cloud.points = {{x_m, 0.01f, 0.01f}};
  cloud.origins = {{0.f, 0.01f, 0.01f}};
  return cloud;
}

ScanNews news_of(const Cloud& cloud, const OccupancyMap& map) {
  return scan_news(cloud, Pose3::Identity(), kRange_m, map);
}

TEST(ScanNews, AreAllThatAScanTellsAnEmptyMap) {
  const ScanNews news = news_of(ray_to(2.01f), {});
  EXPECT_EQ(news.hit, 1u);
  EXPECT_EQ(news.newly_hit, 1u);
  EXPECT_EQ(news.passed, 25u);
  EXPECT_EQ(news.newly_passed, 25u);
  EXPECT_EQ(news.share(), 1.0);
}

TEST(ScanNews, AreNoneOfAScanThatIsInTheMap) {
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    OccupancyMap map;
    const Cloud cloud = random_cloud(seed, 3000);
    const Pose3 pose = to_pose3({3.0, -40.0, 2.5});
    EXPECT_EQ(scan_news(cloud, pose, kRange_m, map).share(), 1.0);
    add_scan(cloud, pose, kRange_m, map);
    const ScanNews news = scan_news(cloud, pose, kRange_m, map);
    EXPECT_EQ(news.share(), 0.0) << seed;
    EXPECT_GT(news.hit, 1000u);
    EXPECT_GT(news.passed, 1000u);
  }
}

// What newly_passed says must be what add_scan does.
TEST(ScanNews, CountThePassedCellsThatTheMapGets) {
  OccupancyMap map;
  add_scan(random_cloud(1, 3000), Pose3::Identity(), kRange_m, map);
  const ScanNews news = news_of(random_cloud(2, 3000), map);
  const std::size_t before = map.passed.size();
  add_scan(random_cloud(2, 3000), Pose3::Identity(), kRange_m, map);
  EXPECT_EQ(news.newly_passed, map.passed.size() - before);
  EXPECT_GT(news.newly_passed, 0u);
}

TEST(ScanNews, AreAThingInSpaceThatWasFree) {
  OccupancyMap map;
  add_scan(ray_to(4.01f), Pose3::Identity(), kRange_m, map);
  EXPECT_EQ(news_of(ray_to(2.01f), map).newly_hit, 1u);
  EXPECT_EQ(news_of(ray_to(2.01f), map).newly_passed, 0u);
}

TEST(ScanNews, AreTheWayThroughAThingThatIsGone) {
  OccupancyMap map;
  add_scan(ray_to(2.01f), Pose3::Identity(), kRange_m, map);
  add_scan(ray_to(4.01f), to_pose3({2.09, 0.0, 0.0}), kRange_m, map);
  const ScanNews news = news_of(ray_to(6.10f), map);
  EXPECT_EQ(news.newly_hit, 0u);
  EXPECT_EQ(news.newly_passed, 1u) << "the cell of the thing at 2.01 m";
}

// The cell at 2.00 m to 2.08 m.
TEST(ScanNews, AreNotWhichPartOfACellWasHit) {
  OccupancyMap map;
  add_scan(ray_to(2.01f), Pose3::Identity(), kRange_m, map);
  EXPECT_EQ(news_of(ray_to(2.07f), map).newly_hit, 0u);
  EXPECT_EQ(news_of(ray_to(2.09f), map).newly_hit, 1u);
}

TEST(ScanNews, HaveNoShareOfNothing) { EXPECT_EQ(news_of({}, {}).share(), 0.0); }

}  // namespace
}  // namespace voxlist
