#include "voxlist/planning/obstacles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "voxlist/simulation/run/simulated_run.h"

namespace voxlist::planning {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180.0;
constexpr float kNone = std::numeric_limits<float>::infinity();

// Three points close together: an obstacle.
Cloud post(float bearing_deg, float range_m, float height_m = 0.5F) {
  const float bearing = bearing_deg * static_cast<float>(kRadPerDeg);
  Cloud cloud;
  for (const float up : {0.0F, 0.02F, 0.04F})
    cloud.points.emplace_back(range_m * std::cos(bearing), range_m * std::sin(bearing),
                              height_m + up);
  return cloud;
}

Cloud operator+(Cloud a, const Cloud& b) {
  a.points.insert(a.points.end(), b.points.begin(), b.points.end());
  return a;
}

bool sees_nothing(const ObstacleScan& scan) {
  return scan.cells_m.empty() && std::all_of(scan.ranges_m.begin(), scan.ranges_m.end(),
                                             [](float range) { return range == kNone; });
}

TEST(Obstacles, AreAtTheirBearingAndRangeAndNowhereElse) {
  Cloud cloud = post(0.0F, 2.0F) + post(90.0F, 3.0F) + post(-90.0F, 4.0F) + post(180.0F, 5.0F);
  cloud.utime_us = 77;
  const ObstacleScan scan = nearest_obstacles(cloud, {});
  EXPECT_EQ(scan.utime_us, 77);
  EXPECT_NEAR(scan.step_rad, kRadPerDeg, 1e-12);
  ASSERT_EQ(scan.ranges_m.size(), 360u);
  EXPECT_FLOAT_EQ(scan.ranges_m[0], 2.0F);
  EXPECT_FLOAT_EQ(scan.ranges_m[90], 3.0F);
  EXPECT_FLOAT_EQ(scan.ranges_m[270], 4.0F);
  EXPECT_FLOAT_EQ(scan.ranges_m[180], 5.0F);
  EXPECT_EQ(std::count(scan.ranges_m.begin(), scan.ranges_m.end(), kNone), 356);
}

TEST(Obstacles, AreInSectorsCentredOnTheirBearing) {
  ObstacleConfig config;
  config.sectors = 4;
  for (const float bearing : {-44.0F, 0.0F, 44.0F})
    EXPECT_LT(nearest_obstacles(post(bearing, 2.0F), config).ranges_m[0], kNone) << bearing;
  for (const float bearing : {46.0F, 134.0F})
    EXPECT_LT(nearest_obstacles(post(bearing, 2.0F), config).ranges_m[1], kNone) << bearing;
}

TEST(Obstacles, HideWhatIsBehindThem) {
  const ObstacleScan scan = nearest_obstacles(post(30.0F, 4.0F) + post(30.0F, 2.0F), {});
  EXPECT_FLOAT_EQ(scan.ranges_m[30], 2.0F);
  EXPECT_EQ(scan.cells_m.size(), 2u);
}

TEST(Obstacles, AreOnlyWhatStandsInTheRobotsWay) {
  EXPECT_TRUE(sees_nothing(nearest_obstacles(post(0.0F, 2.0F, 0.02F), {})));
  EXPECT_TRUE(sees_nothing(nearest_obstacles(post(0.0F, 2.0F, 1.1F), {})));
  EXPECT_FALSE(sees_nothing(nearest_obstacles(post(0.0F, 2.0F, 0.15F), {})));
  EXPECT_FALSE(sees_nothing(nearest_obstacles(post(0.0F, 2.0F, 0.9F), {})));
}

TEST(Obstacles, AreMeasuredFromTheFloorWhereverTheSensorIs) {
  ObstacleConfig config;
  config.floor_z_m = -1.4;
  EXPECT_TRUE(sees_nothing(nearest_obstacles(post(0.0F, 2.0F, -1.38F), config)));
  EXPECT_TRUE(sees_nothing(nearest_obstacles(post(0.0F, 2.0F, 0.5F), config)));
  EXPECT_FLOAT_EQ(nearest_obstacles(post(0.0F, 2.0F, -0.9F), config).ranges_m[0], 2.0F);
}

TEST(Obstacles, AreNotTheRobotItselfNorTooFarToMatter) {
  EXPECT_TRUE(sees_nothing(nearest_obstacles(post(0.0F, 0.25F), {})));
  EXPECT_TRUE(sees_nothing(nearest_obstacles(post(0.0F, 10.5F), {})));
}

TEST(Obstacles, AreNotALonePoint) {
  Cloud lone;
  lone.points.emplace_back(1.0F, 0.0F, 0.5F);
  const ObstacleScan scan = nearest_obstacles(lone + post(0.0F, 3.0F), {});
  EXPECT_FLOAT_EQ(scan.ranges_m[0], 3.0F);
  EXPECT_EQ(scan.cells_m.size(), 1u);

  ObstacleConfig config;
  config.min_points = 1;
  EXPECT_FLOAT_EQ(nearest_obstacles(lone, config).ranges_m[0], 1.0F);
}

TEST(Obstacles, AreTwoPointsOnBothSidesOfASectorsOrACellsEdge) {
  Cloud pair;
  pair.points.emplace_back(1.99F, 0.06F, 0.5F);
  pair.points.emplace_back(2.01F, -0.06F, 0.5F);
  const ObstacleScan scan = nearest_obstacles(pair, {});
  EXPECT_NEAR(scan.ranges_m[2], 1.99, 0.01);
  EXPECT_NEAR(scan.ranges_m[358], 2.01, 0.01);
  EXPECT_EQ(scan.cells_m.size(), 2u);
}

TEST(Obstacles, HaveCellsOnTheGrid) {
  const ObstacleScan scan = nearest_obstacles(post(0.0F, 2.03F) + post(180.0F, 1.07F), {});
  ASSERT_EQ(scan.cells_m.size(), 2u);
  EXPECT_NEAR(scan.cells_m[0].x(), -1.05, 1e-6);
  EXPECT_NEAR(scan.cells_m[1].x(), 2.05, 1e-6);
  EXPECT_NEAR(std::abs(scan.cells_m[1].y()), 0.05, 1e-6);
}

TEST(Obstacles, AreNoneInAnEmptyCloud) { EXPECT_TRUE(sees_nothing(nearest_obstacles({}, {}))); }

TEST(Obstacles, OfASimulatedRoomAreWhereItsWallsAndFurnitureAre) {
  const simulation::SimulationConfig config;
  const simulation::SimulatedRun run(config);
  const ObstacleConfig obstacle_config;
  int seen = 0;
  for (double t = 10.0; t < run.duration_s(); t += 10.0) {
    SCOPED_TRACE(t);
    const Cloud cloud = simulation::scan_sweep(run.scanner(), run.truth(), t, config.sweep, 1);
    const ObstacleScan scan = nearest_obstacles(cloud, obstacle_config);
    const Pose2 T_map_base = run.truth().at(t);
    for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
      if (scan.ranges_m[i] == kNone) continue;
      ++seen;
      const double bearing = static_cast<double>(i) * scan.step_rad, range = scan.ranges_m[i];
      const Eigen::Vector3d hit =
          T_map_base * Eigen::Vector3d(range * std::cos(bearing), range * std::sin(bearing), 0.0);
      const double tolerance = 6.0 * config.sweep.range_sd_m + range * scan.step_rad / 2.0;
      ASSERT_LE(run.building().clearance_m({hit.x(), hit.y()}, 0.05, 1.05), tolerance) << i;
    }
  }
  EXPECT_GT(seen, 1000);
}

}  // namespace
}  // namespace voxlist::planning
