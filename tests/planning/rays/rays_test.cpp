#include <gtest/gtest.h>

#include <cmath>

#include "voxlist/geometry/angle.h"
#include "voxlist/planning/rays/beam_spacing.h"
#include "voxlist/planning/rays/line_drops.h"
#include "voxlist/planning/rays/passed_through.h"
#include "voxlist/planning/rays/single_echoes.h"

namespace voxlist::planning {
namespace {

Cloud at(const Eigen::Vector3f& point, std::int64_t utime_us = 0, int points = 1) {
  Cloud cloud;
  cloud.utime_us = utime_us;
  cloud.points.assign(static_cast<std::size_t>(points), point);
  return cloud;
}

TEST(RayWindow, MovesWhatItKeepsAgainstTheRobot) {
  RayWindow window;
  window.add(at({2.0F, 0.0F, 0.5F}));
  window.advance(to_pose3(Pose2{0.5, 0.0, kTurn_rad / 4.0}), 0);
  ASSERT_EQ(window.rays().size(), 1u);
  EXPECT_NEAR(window.rays()[0].point.x(), 0.0, 1e-5);
  EXPECT_NEAR(window.rays()[0].point.y(), -1.5, 1e-5);
}

TEST(RayWindow, ForgetsWhatIsOld) {
  RayWindow window;
  window.add(at({2.0F, 0.0F, 0.5F}, 10));
  window.advance(Pose3::Identity(), 11);
  EXPECT_TRUE(window.rays().empty());
}

TEST(RayWindow, ForgetsWhatLaterRaysWentThrough) {
  RayWindow window;
  window.add(at({2.0F, 0.0F, 0.5F}));
  for (int i = 0; i < 2; ++i) window.add(at({4.0F, 0.0F, 1.0F}));
  window.advance(Pose3::Identity(), 0);
  EXPECT_EQ(window.rays().size(), 2u);
}

TEST(RayWindow, KeepsAThinThingThatRaysPassBeside) {
  RayWindow window;
  window.add(at({2.0F, 0.0F, 0.5F}));
  for (int i = 0; i < 9; ++i) window.add(at({4.0F, 0.08F, 1.0F}));
  window.advance(Pose3::Identity(), 0);
  EXPECT_EQ(window.rays().size(), 10u);
}

TEST(RayWindow, ForgetsAWideThingThatRaysPassThroughBesideItsPoints) {
  RayWindow window;
  window.add(at({2.0F, 0.0F, 0.5F}, 0, 8));
  for (int i = 0; i < 9; ++i) window.add(at({4.0F, 0.08F, 1.0F}));
  window.advance(Pose3::Identity(), 0);
  EXPECT_EQ(window.rays().size(), 9u);
}

TEST(Echo, IsMixedBetweenItsNeighboursAlone) {
  Cloud cloud;
  for (const float range_m : {1.0F, 1.5F, 3.0F, 3.0F, 2.0F, 3.0F}) {
    const float bearing = 0.0175F * static_cast<float>(cloud.points.size());
    cloud.points.emplace_back(range_m * std::cos(bearing), range_m * std::sin(bearing), 0.0F);
  }
  const std::vector<Echo> echoes = look_at_echoes(cloud);
  EXPECT_TRUE(echoes[1].is_mixed);
  EXPECT_FALSE(echoes[3].is_mixed);
  EXPECT_FALSE(echoes[4].is_mixed) << "a leg in front of a wall";
}

// One line of beams of 1 deg, straight ahead and down, from 0.8 m above floor that it meets 2 m
// ahead; `meets_m(y)`: how far ahead it ends where it passes y at 2 m.
template <class Meets>
Cloud line_over(const Meets& meets_m) {
  Cloud cloud;
  for (int beam = -30; beam <= 30; ++beam) {
    const double y = 2.15 * std::tan(beam * kRadPerDeg), x = meets_m(y);
    cloud.points.push_back(Eigen::Vector3d(x, x / 2.0 * y, 0.8 - 0.4 * x).cast<float>());
    cloud.origins.emplace_back(0.0F, 0.0F, 0.8F);
  }
  return cloud;
}

int points_in(const std::vector<LineDrop>& drops) {
  int points = 0;
  for (const LineDrop& drop : drops) points += drop.below_m > 0.0F;
  return points;
}

TEST(LineDrops, AreTheFarWallOfAHole) {
  const auto drops =
      find_line_drops(line_over([](double y) { return std::abs(y) < 0.15 ? 2.1 : 2.0; }));
  EXPECT_EQ(points_in(drops), 7);
  for (const LineDrop& drop : drops)
    if (drop.below_m > 0.0F) {
      EXPECT_NEAR(drop.below_m, 0.04, 1e-3);
      EXPECT_TRUE(drop.is_between);
    }
}

TEST(LineDrops, AreTheFirstBeamsBeyondAKerb) {
  for (const double side : {-1.0, 1.0}) {
    const auto drops =
        find_line_drops(line_over([&](double y) { return side * y > 0.1 ? 2.3 : 2.0; }));
    EXPECT_EQ(points_in(drops), 8);
    EXPECT_GT(drops[side > 0.0 ? 34 : 26].below_m, 0.1F);
    EXPECT_FALSE(drops[side > 0.0 ? 34 : 26].is_between);
  }
}

TEST(LineDrops, AreNeitherARollingRobotNorNoiseNorAWall) {
  const auto noise_m = [](double y) { return 0.01 * std::sin(1000.0 * y); };
  EXPECT_EQ(points_in(find_line_drops(line_over([&](double y) { return 2.0 + noise_m(y); }))), 0);
  EXPECT_EQ(points_in(find_line_drops(line_over([](double y) { return 2.0 + 0.2 * y; }))), 0);
  const auto wall_m = [](double y) { return y < 0.4 ? 2.0 : std::max(0.5, 2.0 - 2.0 * (y - 0.4)); };
  EXPECT_EQ(points_in(find_line_drops(line_over(wall_m))), 0);
}

TEST(BeamSpacing, IsThatOfARingLaser) {
  Cloud cloud;
  for (int ring = 1; ring <= 8; ++ring)
    for (int column = 0; column < 360; ++column) {
      const double down = 2.0 * ring * kRadPerDeg, turn = column * kRadPerDeg;
      cloud.points.push_back(
          Eigen::Vector3d(3.0 * std::cos(turn), 3.0 * std::sin(turn), 0.8 - 3.0 * std::tan(down))
              .cast<float>());
    }
  cloud.origins.assign(cloud.points.size(), {0.0F, 0.0F, 0.8F});
  BeamSpacing spacing;
  spacing.add(cloud);
  EXPECT_NEAR(spacing.spacing_rad(), 2.0 * kRadPerDeg, 0.01 * kRadPerDeg);
}

// A beam that leaves 0.8 m up, 21.8 deg down, meets the floor at 2 m; 17.0 deg down, at 2.62 m.
TEST(BeamSpacing, SaysWhereTheNextBeamMeetsTheFloor) {
  EXPECT_NEAR(next_on_floor_m(2.0, 0.8, 4.8 * kRadPerDeg), 2.617, 0.01);
  EXPECT_TRUE(std::isinf(next_on_floor_m(20.0, 0.8, 4.8 * kRadPerDeg)));
}

}  // namespace
}  // namespace voxlist::planning
