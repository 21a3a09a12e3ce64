#include "voxlist/matching/scan/lonely_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <set>

namespace voxlist::matching {
namespace {

std::vector<std::uint32_t> all_of(const Cloud& cloud) {
  std::vector<std::uint32_t> indices(cloud.points.size());
  std::iota(indices.begin(), indices.end(), 0U);
  return indices;
}

// A room of 6 x 5 x 2.6 m, seen by rays that are spread evenly over all directions.
Cloud room_scan(int rays) {
  const Eigen::Vector3d low(-2.5, -2.0, -1.0), high(3.5, 3.0, 1.6);
  Cloud cloud;
  for (int i = 0; i < rays; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / rays, turn = 2.399963 * i;
    const Eigen::Vector3d way(std::sqrt(1.0 - z * z) * std::cos(turn),
                              std::sqrt(1.0 - z * z) * std::sin(turn), z);
    const double range_m =
        (way.array() > 0.0).select(high, low).cwiseQuotient(way).cwiseAbs().minCoeff();
    cloud.points.push_back((range_m * way).cast<float>());
  }
  return cloud;
}

// Every twentieth return of a scan comes from somewhere on its way: the points that do not.
std::set<std::uint32_t> shorten(Cloud& cloud) {
  std::mt19937 random(1);
  std::set<std::uint32_t> others;
  for (std::uint32_t i = 0; i < cloud.points.size(); ++i)
    if (random() % 20 == 0)
      cloud.points[i] *= static_cast<float>(random() % 1000) / 1000.F;
    else
      others.insert(i);
  return others;
}

class LonelyPoints : public testing::TestWithParam<int> {};

TEST_P(LonelyPoints, AreShortReturnsAndHardlyAnyOthers) {
  Cloud cloud = room_scan(GetParam());
  const std::set<std::uint32_t> others = shorten(cloud);
  const auto kept = without_lonely(cloud, all_of(cloud));
  const auto right = static_cast<std::size_t>(
      std::count_if(kept.begin(), kept.end(), [&](std::uint32_t i) { return others.contains(i); }));
  EXPECT_GT(right, others.size() * 97 / 100);
  EXPECT_LT(kept.size() - right, (cloud.points.size() - others.size()) / 4)
      << "three quarters of the short ones are left out";
}

INSTANTIATE_TEST_SUITE_P(Scans, LonelyPoints, testing::Values(5'000, 40'000));

TEST(WithoutLonely, KeepsAllWhereTheLasersRaysAreFarApart) {
  const Cloud cloud = room_scan(60);
  EXPECT_EQ(without_lonely(cloud, all_of(cloud)), all_of(cloud));
}

TEST(WithoutLonely, IsOfNoPointsNone) { EXPECT_TRUE(without_lonely({}, {}).empty()); }

TEST(WithoutLonely, EndsWhereAllPointsAreAtOneSpot) {
  Cloud cloud;
  cloud.points.assign(1'000, Eigen::Vector3f(2.F, 1.F, 0.F));
  EXPECT_EQ(without_lonely(cloud, all_of(cloud)).size(), 1'000U);
}

TEST(WithoutLonely, DoesNotDependOnTheOrderOfThePoints) {
  Cloud cloud = room_scan(20'000);
  shorten(cloud);
  std::vector<std::uint32_t> backwards = all_of(cloud);
  std::reverse(backwards.begin(), backwards.end());
  const auto forwards = without_lonely(cloud, all_of(cloud));
  const auto kept = without_lonely(cloud, backwards);
  EXPECT_EQ(std::vector<std::uint32_t>(kept.rbegin(), kept.rend()), forwards);
}

}  // namespace
}  // namespace voxlist::matching
