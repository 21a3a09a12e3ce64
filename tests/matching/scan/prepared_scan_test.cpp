#include "voxlist/matching/scan/prepared_scan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "tests/matching/synthetic_room.h"

namespace voxlist::matching {
namespace {

// A floor of 8 x 8 m, and a wall along its side.
Cloud floor_and_wall() {
  Cloud cloud;
  for (float x = -4.F; x < 4.F; x += 0.05F) {
    for (float y = -4.F; y < 4.F; y += 0.05F) cloud.points.emplace_back(x, y, 0.01F);
    for (float z = 0.1F; z < 2.F; z += 0.05F) cloud.points.emplace_back(x, 4.F, z);
  }
  cloud.points.emplace_back(std::numeric_limits<float>::quiet_NaN(), 0.F, 0.F);
  return cloud;
}

Cloud room_scan() { return {0, synthetic_room(6.0, 5.0, {2.5, 2.0, 0.7}, 5000, 1).scan, {}}; }

Cloud reversed(Cloud cloud) {
  std::reverse(cloud.points.begin(), cloud.points.end());
  std::reverse(cloud.origins.begin(), cloud.origins.end());
  return cloud;
}

void expect_equal(const std::vector<ScanRay>& a, const std::vector<ScanRay>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].origin, b[i].origin);
    EXPECT_EQ(a[i].end, b[i].end);
  }
}

template <class Points, class HeightOf>
std::ptrdiff_t on_floor(const Points& points, const HeightOf& height_of) {
  return std::count_if(points.begin(), points.end(),
                       [&](const auto& p) { return height_of(p) < 0.05F; });
}

TEST(PreparedScan, RefinesWithWallsAndLeavesTheFloorOut) {
  const Cloud cloud = floor_and_wall();
  const PreparedScan scan(cloud);
  const auto& points = scan.points().points;
  EXPECT_GT(points.size(), 1000U);
  EXPECT_LT(on_floor(points, [](const auto& p) { return p.z(); }),
            static_cast<std::ptrdiff_t>(points.size() / 10));
}

TEST(PreparedScan, RefinesWithTheFloorWhenNothingElseIsThere) {
  Cloud cloud = floor_and_wall();
  std::erase_if(cloud.points, [](const auto& p) { return !(p.z() < 0.05F); });
  EXPECT_GT(PreparedScan(cloud).points().points.size(), 1000U);
}

TEST(PreparedScan, WeighsByFloorAndWallsAlike) {
  const Cloud cloud = floor_and_wall();
  const PreparedScan scan(cloud);
  const auto height = [](const ScanRay& ray) { return ray.end.z(); };
  for (const auto* rays : {&scan.near_rays(), &scan.even_rays(), &scan.few_rays()}) {
    EXPECT_GT(rays->size(), 300U);
    EXPECT_LE(rays->size(), 3000U);
    EXPECT_GT(on_floor(*rays, height), 10);
  }
  // Near rays are so many that the floor, one layer, is cut to what a wall gives to its own.
  EXPECT_LT(on_floor(scan.near_rays(), height),
            static_cast<std::ptrdiff_t>(scan.near_rays().size() / 10));
  EXPECT_LE(scan.few_rays().size(), 600U);
}

TEST(PreparedScan, DoesNotDependOnTheOrderOfTheCloud) {
  Cloud cloud = room_scan();
  for (const auto& p : cloud.points) cloud.origins.emplace_back(0.F, 0.01F * p.z(), 0.5F);
  const Cloud other = reversed(cloud);
  const PreparedScan scan(cloud, {.refine_points = 500}), again(other, {.refine_points = 500});
  EXPECT_EQ(scan.points().points, again.points().points);
  EXPECT_EQ(scan.points().origins, again.points().origins);
  EXPECT_EQ(scan.points().radius_m, again.points().radius_m);
  EXPECT_LE(scan.points().points.size(), 500U);
  EXPECT_GT(scan.points().points.size(), 300U);
  EXPECT_EQ(scan.search_points(scan.in_range()), again.search_points(again.in_range()));
  expect_equal(scan.near_rays(), again.near_rays());
  expect_equal(scan.few_rays(), again.few_rays());
}

TEST(PreparedScan, SearchesWithOnePointOfEachOfTheWidestCubesThatAreEnough) {
  const Cloud cloud = room_scan();
  const PreparedScan scan(cloud);
  std::vector<std::uint32_t> telling = scan.in_range();
  ASSERT_EQ(telling.size(), cloud.points.size());
  for (const std::size_t most : {5000U, 1000U, 400U}) {
    telling.resize(most);
    const auto points = scan.search_points(telling);
    EXPECT_GE(points.size(), 300U);
    EXPECT_LT(points.size(), 4 * 300U);
  }
  telling.resize(299);
  EXPECT_EQ(scan.search_points(telling).size(), 299U);
}

TEST(PreparedScan, ReachesAsFarAsMostOfItsPoints) {
  Cloud cloud;
  for (int i = 0; i < 100; ++i)
    cloud.points.emplace_back(i < 95 ? 20.F : 50.F, 0.01F * float(i), 1.F);
  EXPECT_EQ(PreparedScan(cloud).reach_m(), 24.0);
  EXPECT_EQ(PreparedScan(cloud, {.max_range_m = 22.0}).reach_m(), 22.0);
}

TEST(PreparedScan, HasOnlyPointsOfTheBandOfHeightsAboveTheFloor) {
  const Cloud cloud = floor_and_wall();
  const PreparedScan scan(cloud, {.match_heights_m = {1.0, 1.5}}, 0.2);
  ASSERT_GT(scan.in_range().size(), 1000U);
  for (const std::uint32_t i : scan.in_range()) {
    EXPECT_GE(cloud.points[i].z(), 1.2F);
    EXPECT_LE(cloud.points[i].z(), 1.7F);
  }
  for (const ScanRay& ray : scan.near_rays()) EXPECT_GE(ray.end.z(), 1.2F);
  for (const auto& p : scan.points().points) EXPECT_GE(p.z(), 1.2F);
  EXPECT_EQ(PreparedScan(cloud, {.match_heights_m = {-1.0, 9.0}}).in_range().size(),
            PreparedScan(cloud).in_range().size());
}

TEST(PreparedScan, RefusesABandThatIsNone) {
  for (const std::vector<double>& band :
       {std::vector{1.0}, {2.0, 1.0}, {1.0, 1.0}, {1.0, 2.0, 3.0}})
    EXPECT_THROW(check(ScanConfig{.match_heights_m = band}), std::invalid_argument);
  EXPECT_NO_THROW(check(ScanConfig{.match_heights_m = {1.0, 2.0}}));
  EXPECT_NO_THROW(check(ScanConfig{}));
}

TEST(PreparedScan, OfNothingHasNothing) {
  const Cloud nothing, far{0, {{1000.F, 0.F, 0.F}}, {}};
  for (const Cloud* cloud : {&nothing, &far}) {
    const PreparedScan scan(*cloud);
    EXPECT_TRUE(scan.points().points.empty());
    EXPECT_TRUE(scan.near_rays().empty());
    EXPECT_TRUE(scan.search_points(scan.in_range()).empty());
  }
}

TEST(PreparedScan, UnderALidHasNothing) {
  Cloud cloud;
  for (int i = 0; i < 200; ++i) {
    const auto angle = static_cast<float>(i) * 0.1F;
    cloud.points.push_back({0.4F * std::cos(angle), 0.4F * std::sin(angle), 0.001F * float(i)});
  }
  EXPECT_TRUE(PreparedScan(cloud).in_range().empty());
  cloud.points.push_back({0.6F, 0.0F, 0.0F});
  EXPECT_EQ(PreparedScan(cloud).in_range().size(), 201u);
}

}  // namespace
}  // namespace voxlist::matching
