#include "voxlist/planning/obstacles/obstacle_finder.h"

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
  if (!a.origins.empty()) a.origins.resize(a.points.size(), {0.0F, 0.0F, 0.8F});
  return a;
}

// The floor within 20 deg of straight ahead, seen from 0.8 m above the robot, a point each 5 cm.
Cloud floor_ahead(float from_m, float to_m) {
  Cloud cloud;
  for (float range_m = from_m; range_m <= to_m; range_m += 0.05F)
    for (float bearing = -0.35F; bearing <= 0.35F; bearing += 0.05F / range_m)
      cloud.points.emplace_back(range_m * std::cos(bearing), range_m * std::sin(bearing), 0.0F);
  cloud.origins.assign(cloud.points.size(), {0.0F, 0.0F, 0.8F});
  return cloud;
}

const std::vector<float>& nearest(const ObstacleScan& scan) {
  return scan.nearest(ObstacleType::kObstacle);
}

ObstacleScan look(const Cloud& cloud, const ObstacleConfig& config = {}) {
  return ObstacleFinder(config).take(cloud, ObstacleFinder::Part::kWhole);
}

bool sees_nothing(const ObstacleScan& scan) {
  return scan.cells.empty() && std::all_of(nearest(scan).begin(), nearest(scan).end(),
                                           [](float range) { return range == kNone; });
}

TEST(Obstacles, AreAtTheirBearingAndRangeAndNowhereElse) {
  Cloud cloud = post(0.0F, 2.0F) + post(90.0F, 3.0F) + post(-90.0F, 4.0F) + post(180.0F, 5.0F);
  cloud.utime_us = 77;
  const ObstacleScan scan = look(cloud);
  EXPECT_EQ(scan.utime_us, 77);
  EXPECT_NEAR(scan.step_rad, kRadPerDeg, 1e-12);
  ASSERT_EQ(nearest(scan).size(), 360u);
  EXPECT_FLOAT_EQ(nearest(scan)[0], 2.0F);
  EXPECT_FLOAT_EQ(nearest(scan)[90], 3.0F);
  EXPECT_FLOAT_EQ(nearest(scan)[270], 4.0F);
  EXPECT_FLOAT_EQ(nearest(scan)[180], 5.0F);
  EXPECT_EQ(std::count(nearest(scan).begin(), nearest(scan).end(), kNone), 356);
}

TEST(Obstacles, AreInSectorsCentredOnTheirBearing) {
  ObstacleConfig config;
  config.sectors = 4;
  for (const float bearing : {-44.0F, 0.0F, 44.0F})
    EXPECT_LT(nearest(look(post(bearing, 2.0F), config))[0], kNone) << bearing;
  for (const float bearing : {46.0F, 134.0F})
    EXPECT_LT(nearest(look(post(bearing, 2.0F), config))[1], kNone) << bearing;
}

TEST(Obstacles, HideWhatIsBehindThem) {
  const ObstacleScan scan = look(post(30.0F, 4.0F) + post(30.0F, 2.0F));
  EXPECT_FLOAT_EQ(nearest(scan)[30], 2.0F);
  EXPECT_EQ(scan.cells.size(), 2u);
}

TEST(Obstacles, AreOnlyWhatStandsInTheRobotsWay) {
  const Cloud seen = floor_ahead(0.6F, 4.0F);
  EXPECT_TRUE(sees_nothing(look(seen + post(0.0F, 2.0F, 0.02F))));
  EXPECT_TRUE(sees_nothing(look(seen + post(0.0F, 2.0F, 1.1F))));
  EXPECT_FALSE(sees_nothing(look(seen + post(0.0F, 2.0F, 0.15F))));
  EXPECT_FALSE(sees_nothing(look(seen + post(0.0F, 2.0F, 0.9F))));
}

// Where no floor was seen a ramp explains what is low, as long as a strip may be unseen.
TEST(Obstacles, AreNotWhatMayBeARamp) {
  EXPECT_TRUE(sees_nothing(look(post(0.0F, 2.0F, 0.15F))));
  EXPECT_FALSE(sees_nothing(look(post(0.0F, 2.0F, 0.3F))));
}

TEST(Obstacles, HangWhereTheFloorIsSeenBehindThem) {
  const Cloud beam = post(0.0F, 2.0F, 0.7F);
  const ObstacleScan scan = look(floor_ahead(0.6F, 4.0F) + beam);
  EXPECT_FLOAT_EQ(scan.nearest(ObstacleType::kOverhang)[0], 2.0F);
  EXPECT_EQ(nearest(scan)[0], kNone);
  EXPECT_FLOAT_EQ(nearest(look(floor_ahead(0.6F, 1.9F) + beam))[0], 2.0F);
}

TEST(Obstacles, ArePartOfTheFloorOnARamp) {
  for (const float slope : {0.17F, -0.17F}) {
    Cloud ramp = floor_ahead(0.6F, 5.0F);
    for (Eigen::Vector3f& p : ramp.points) p.z() += slope * std::max(0.0F, p.x() - 1.0F);
    const ObstacleScan scan = look(ramp);
    EXPECT_TRUE(scan.cells.empty()) << slope;
    EXPECT_NEAR(scan.ground_seen_to_m[0], 5.0, 0.15) << slope;
  }
}

TEST(GroundSeen, EndsAtWhatStandsAndAtAStripThatNoBeamSkips) {
  const Cloud near = floor_ahead(0.6F, 2.0F), far = floor_ahead(2.8F, 4.0F);
  EXPECT_NEAR(look(near + far).ground_seen_to_m[0], 2.0, 0.15);
  EXPECT_NEAR(look(floor_ahead(0.6F, 4.0F) + post(0.0F, 3.0F, 0.15F)).ground_seen_to_m[0], 2.95, 0.15);
  EXPECT_NEAR(look(floor_ahead(0.6F, 4.0F)).ground_seen_to_m[0], 4.0, 0.15);
}

TEST(GroundSeen, IsNothingWithoutFloorNearTheRobot) {
  EXPECT_EQ(look(floor_ahead(1.6F, 4.0F)).ground_seen_to_m[0], 0.0F);
  EXPECT_EQ(look({}).ground_seen_to_m[0], 0.0F);
  EXPECT_EQ(look(floor_ahead(0.6F, 4.0F)).ground_seen_to_m[180], 0.0F);
}

TEST(Obstacles, AreMeasuredFromTheFloorWhereverTheSensorIs) {
  ObstacleConfig config;
  config.floor_z_m = -1.4;
  EXPECT_TRUE(sees_nothing(look(post(0.0F, 2.0F, -1.38F), config)));
  EXPECT_TRUE(sees_nothing(look(post(0.0F, 2.0F, 0.5F), config)));
  EXPECT_FLOAT_EQ(nearest(look(post(0.0F, 2.0F, -0.9F), config))[0], 2.0F);
}

TEST(Obstacles, AreNotTheRobotItselfNorTooFarToMatter) {
  EXPECT_TRUE(sees_nothing(look(post(0.0F, 0.25F))));
  EXPECT_TRUE(sees_nothing(look(post(0.0F, 10.5F))));
}

TEST(Obstacles, AreALonePointOnlyNearTheRobot) {
  Cloud near, far;
  near.points.emplace_back(1.9F, 0.0F, 0.5F);
  far.points.emplace_back(2.1F, 0.0F, 0.5F);
  EXPECT_FLOAT_EQ(nearest(look(near))[0], 1.9F);
  EXPECT_TRUE(sees_nothing(look(far)));

  ObstacleConfig config;
  config.min_points = 1;
  EXPECT_FLOAT_EQ(nearest(look(far, config))[0], 2.1F);
}

// Half of the beam on a post in front, half on the wall behind it.
TEST(Obstacles, AreNotAPointBetweenItsNeighboursRanges) {
  Cloud cloud;
  for (const float range_m : {1.0F, 1.5F, 3.0F}) {
    const auto bearing = static_cast<float>(cloud.points.size()) * 0.0175F;
    cloud.points.emplace_back(range_m * std::cos(bearing), range_m * std::sin(bearing), 0.5F);
  }
  cloud.origins.assign(3, {0.0F, 0.0F, 0.5F});
  const ObstacleScan scan = look(cloud);
  EXPECT_FLOAT_EQ(nearest(scan)[0], 1.0F);
  EXPECT_EQ(nearest(scan)[1], kNone);
}

TEST(Obstacles, AreTwoPointsOnBothSidesOfASectorsOrACellsEdge) {
  Cloud pair;
  pair.points.emplace_back(1.99F, 0.06F, 0.5F);
  pair.points.emplace_back(2.01F, -0.06F, 0.5F);
  const ObstacleScan scan = look(pair);
  EXPECT_NEAR(nearest(scan)[2], 1.99, 0.01);
  EXPECT_NEAR(nearest(scan)[358], 2.01, 0.01);
  EXPECT_EQ(scan.cells.size(), 2u);
}

TEST(Obstacles, HaveCellsOnTheGrid) {
  const ObstacleScan scan = look(post(0.0F, 2.03F) + post(180.0F, 1.07F));
  ASSERT_EQ(scan.cells.size(), 2u);
  EXPECT_NEAR(scan.cells[0].centre.x(), -1.05, 1e-6);
  EXPECT_NEAR(scan.cells[1].centre.x(), 2.05, 1e-6);
  EXPECT_NEAR(std::abs(scan.cells[1].centre.y()), 0.05, 1e-6);
}

TEST(Obstacles, AreNoneInAnEmptyCloud) { EXPECT_TRUE(sees_nothing(look({}))); }

TEST(Obstacles, OfASimulatedRoomAreWhereItsWallsAndFurnitureAre) {
  const simulation::SimulationConfig config;
  const simulation::SimulatedRun run(config);
  const ObstacleConfig obstacle_config;
  int seen = 0;
  for (double t = 10.0; t < run.duration_s(); t += 10.0) {
    SCOPED_TRACE(t);
    const Cloud cloud = simulation::scan_sweep(run.scanner(), run.truth(), t, config.sweep, 1);
    const ObstacleScan scan = look(cloud, obstacle_config);
    const Pose2 T_map_base = run.truth().at(t);
    for (std::size_t i = 0; i < nearest(scan).size(); ++i) {
      if (nearest(scan)[i] == kNone) continue;
      ++seen;
      const double bearing = static_cast<double>(i) * scan.step_rad, range = nearest(scan)[i];
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
