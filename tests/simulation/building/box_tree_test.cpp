#include "voxlist/simulation/building/box_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "voxlist/simulation/random.h"

namespace voxlist::simulation {
namespace {

using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;

Vector3d random_point(Random& random, double reach) {
  const double x = random.uniform(-reach, reach);
  const double y = random.uniform(-reach, reach);
  const double z = random.uniform(-reach, reach);
  return {x, y, z};
}

TEST(BoxTree, MeasuresTheDistanceToAFace) {
  const BoxTree tree({{{5.0, 0.0, 0.0}, {1.0, 2.0, 2.0}, 0.0}});
  EXPECT_DOUBLE_EQ(tree.range(Vector3d::Zero(), Vector3d::UnitX()).value(), 4.0);
  const double slope = 0.3;
  const Vector3d oblique{std::cos(slope), std::sin(slope), 0.0};
  EXPECT_NEAR(tree.range(Vector3d::Zero(), oblique).value(), 4.0 / std::cos(slope), 1e-12);
}

TEST(BoxTree, MeasuresTheDistanceToTheEdgeOfATurnedBox) {
  const BoxTree tree({{{5.0, 0.0, 0.0}, {1.0, 1.0, 1.0}, kPi / 4}});
  EXPECT_NEAR(tree.range(Vector3d::Zero(), Vector3d::UnitX()).value(), 5.0 - std::sqrt(2.0), 1e-12);
}

TEST(BoxTree, SaysNothingWhenTheRayMissesOrPointsAway) {
  const BoxTree tree({{{5.0, 0.0, 0.0}, {1.0, 1.0, 1.0}, 0.0}});
  EXPECT_FALSE(tree.range(Vector3d::Zero(), Vector3d::UnitY()));
  EXPECT_FALSE(tree.range(Vector3d::Zero(), -Vector3d::UnitX()));
  EXPECT_FALSE(BoxTree({}).range(Vector3d::Zero(), Vector3d::UnitX()));
}

TEST(BoxTree, IsAtZeroInsideABox) {
  const BoxTree tree({{{0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}, 0.0}});
  EXPECT_EQ(tree.range({0.5, 0.2, 0.0}, Vector3d::UnitX()).value(), 0.0);
}

TEST(BoxTree, FindsTheNearestOfManyAsTryingEachDoes) {
  Random random(11);
  std::vector<Box> boxes;
  for (int i = 0; i < 200; ++i) {
    const Vector3d centre = random_point(random, 5.0);
    const Vector3d half = random_point(random, 0.5).cwiseAbs();
    boxes.push_back({centre, half, random.uniform(0.0, kPi)});
  }
  const BoxTree tree(boxes);
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vector3d origin = random_point(random, 6.0);
    const Vector3d direction = random_point(random, 1.0).normalized();
    std::optional<double> nearest;
    for (const Box& box : boxes)
      if (const auto range = BoxTree({box}).range(origin, direction))
        nearest = std::min(*range, nearest.value_or(*range));
    const auto found = tree.range(origin, direction);
    ASSERT_EQ(found, nearest);
    if (found) ++hits;
  }
  EXPECT_GT(hits, 300);
}

TEST(Box, KnowsHowFarAPointIsFromItsSurface) {
  const Box box{{1.0, 0.0, 0.0}, {1.0, 2.0, 3.0}, 0.0};
  EXPECT_DOUBLE_EQ(box.surface_distance_m({2.5, 0.0, 0.0}), 0.5);
  EXPECT_DOUBLE_EQ(box.surface_distance_m({1.8, 0.0, 0.0}), 0.2);
  EXPECT_DOUBLE_EQ(box.surface_distance_m({5.0, 6.0, 0.0}), 5.0);
}

TEST(Box, KnowsHowFarAPointIsFromItsTurnedFootprint) {
  const Box box{{0.0, 0.0, 7.0}, {1.0, 2.0, 3.0}, kPi / 2};
  EXPECT_NEAR(box.distance_m({2.5, 0.0}), 0.5, 1e-12);
  EXPECT_NEAR(box.distance_m({0.0, 2.5}), 1.5, 1e-12);
  EXPECT_EQ(box.distance_m({1.9, 0.9}), 0.0);
}

}  // namespace
}  // namespace voxlist::simulation
