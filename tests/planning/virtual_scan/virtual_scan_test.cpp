#include "voxlist/planning/virtual_scan/virtual_scan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/simulation/sphere_scan.h"
#include "voxlist/simulation/building/building.h"

namespace voxlist::planning {
namespace {

constexpr float kNothing = std::numeric_limits<float>::infinity();

// Bearings 90 deg apart: ahead, left, behind, right.
constexpr ScanBand kBand{.low_m = 0.1, .high_m = 1.0, .min_range_m = 0.3, .bearings = 4};

// Rays from a laser 0.8 m above the floor.
Cloud seen(std::vector<Eigen::Vector3f> points) {
  Cloud cloud{7, std::move(points), {}};
  cloud.origins.assign(cloud.points.size(), {0.F, 0.F, 0.8F});
  return cloud;
}

TEST(VirtualScan, HasTheNearestAndTheFurthestPointOfEachBearing) {
  const VirtualScan scan = virtual_scan(
      seen({{3.F, 0.1F, 0.5F}, {2.F, 0.F, 0.9F}, {5.F, -0.1F, 0.2F}, {0.F, 4.F, 0.5F}}), kBand);
  EXPECT_EQ(scan.utime_us, 7);
  ASSERT_EQ(scan.nearest_m.size(), 4U);
  EXPECT_FLOAT_EQ(scan.nearest_m[0], 2.F);
  EXPECT_NEAR(scan.furthest_m[0], 5.F, 0.01F);
  EXPECT_FLOAT_EQ(scan.nearest_m[1], 4.F);
  EXPECT_FLOAT_EQ(scan.furthest_m[1], 4.F);
  EXPECT_NEAR(scan.step_rad, std::acos(0.0), 1e-9);
}

TEST(VirtualScan, TellsWhereNothingWasSeenFromWhereNobodyLooked) {
  // Ahead the floor is hit, which is below the band; to the left the ceiling: that ray rose from
  // within the band; behind, a ray starts above the robot, and rises.
  Cloud cloud = seen({{3.F, 0.F, 0.F}, {0.F, 3.F, 2.5F}, {-3.F, 0.F, 2.5F}});
  cloud.origins[2].z() = 1.4F;
  const VirtualScan scan = virtual_scan(cloud, kBand);
  for (const std::vector<float>* ranges : {&scan.nearest_m, &scan.furthest_m}) {
    EXPECT_EQ((*ranges)[0], kNothing);
    EXPECT_EQ((*ranges)[1], kNothing);
    EXPECT_TRUE(std::isnan((*ranges)[3]));
  }
  EXPECT_TRUE(std::isnan(scan.nearest_m[2]));
}

TEST(VirtualScan, LeavesOutTheRobotItselfAndPointsThatAreNone) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const VirtualScan scan =
      virtual_scan(seen({{0.2F, 0.1F, 0.5F}, {nan, 0.F, 0.5F}, {2.F, 0.F, nan}}), kBand);
  for (const float range_m : scan.nearest_m) EXPECT_TRUE(std::isnan(range_m));
}

TEST(VirtualScan, LooksForTheFurthestPointOverPeoplesHeads) {
  const VirtualScan scan =
      virtual_scan(seen({{2.F, 0.F, 0.9F}, {6.F, 0.F, 1.9F}, {8.F, 0.F, 2.5F}}), kBand);
  EXPECT_FLOAT_EQ(scan.nearest_m[0], 2.F);
  EXPECT_FLOAT_EQ(scan.furthest_m[0], 6.F);
}

TEST(VirtualScan, TakesItsHeightsFromTheRobot) {
  RobotProfile robot;
  robot.step_m = 0.02;
  robot.height_m = 0.4;
  robot.clearance_m = 0.1;
  robot.radius_m = 0.25;
  const ScanBand band = band_of(robot);
  EXPECT_DOUBLE_EQ(band.low_m, 0.02);
  EXPECT_DOUBLE_EQ(band.high_m, 0.5);
  EXPECT_DOUBLE_EQ(band.min_range_m, 0.25);
}

TEST(VirtualScan, DependsOnTheRobotsHeight) {
  const Cloud table = seen({{2.F, 0.F, 0.75F}, {4.F, 0.F, 0.3F}});
  const auto nearest_m = [&](double height_m) {
    ScanBand band = kBand;
    band.high_m = height_m;
    return virtual_scan(table, band).nearest_m[0];
  };
  EXPECT_FLOAT_EQ(nearest_m(0.45), 4.F);
  EXPECT_FLOAT_EQ(nearest_m(1.0), 2.F);
}

// Of a scan without noise in a building: no ray at the laser's own height gets past the nearest
// point by more than its neighbours are apart, and both ends lie on something solid.
TEST(VirtualScan, EndsOnWhatStandsInABuilding) {
  const simulation::World world(simulation::make_building({.seed = 5}));
  const Pose2 robot = world.building().rooms.empty()
                          ? Pose2{}
                          : Pose2{world.building().rooms[0].centre().x(),
                                  world.building().rooms[0].centre().y(), 0.4};
  simulation::SphereScanConfig laser;
  laser.range_sd_m = 0.0;
  const VirtualScan scan =
      virtual_scan(simulation::scan_sphere(world, robot, laser, 1), {.bearings = 360});
  int known = 0;
  for (std::size_t i = 0; i < scan.nearest_m.size(); ++i) {
    if (!std::isfinite(scan.nearest_m[i])) continue;
    ++known;
    EXPECT_LE(scan.nearest_m[i], scan.furthest_m[i]);
    const double bearing = robot.yaw_rad + static_cast<double>(i) * scan.step_rad;
    const Eigen::Vector3d ahead(std::cos(bearing), std::sin(bearing), 0.0);
    const auto wall_m = world.range({robot.x_m, robot.y_m, 1.0}, ahead, 0.0);
    ASSERT_TRUE(wall_m);
    EXPECT_LE(scan.nearest_m[i], *wall_m + 0.3) << i;
    const Eigen::Vector2d hit =
        Eigen::Vector2d(robot.x_m, robot.y_m) + double(scan.nearest_m[i]) * ahead.head<2>();
    EXPECT_LT(world.building().clearance_m(hit, 0.03, 1.25), 0.1) << i;
  }
  EXPECT_GT(known, 350);
}

}  // namespace
}  // namespace voxlist::planning
