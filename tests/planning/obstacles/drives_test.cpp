// What the obstacle finder says while a robot drives under the mirror scanner: simulated slices.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/bench/obstacles/mirror_drive.h"
#include "tests/bench/obstacles/scenes.h"
#include "voxlist/planning/obstacles/obstacle_finder.h"

namespace voxlist::planning {
namespace {

using bench::MirrorDrive;
using bench::MirrorDriveConfig;
using bench::SceneKind;

// Calls see(scan, t) for each slice of a drive.
template <class See>
void drive_on(const MirrorDrive& drive, double seconds, bool with_odometry, const See& see) {
  ObstacleFinder finder{ObstacleConfig{}};
  for (double t_s = MirrorDrive::kSlice_s; t_s < seconds; t_s += MirrorDrive::kSlice_s) {
    for (const double before_s : {0.04, 0.02, 0.0})
      if (with_odometry)
        finder.add_odometry(
            {std::llround((t_s - before_s) * 1e6), drive.T_odom_base(t_s - before_s)});
    see(finder.take(drive.slice(t_s), ObstacleFinder::Part::kSlice), t_s);
  }
}

int drops_of(const ObstacleScan& scan) {
  int drops = 0;
  for (const ObstacleCell& cell : scan.cells) drops += cell.type == ObstacleType::kNegative;
  return drops;
}

MirrorDriveConfig towards_the_edge(double from_m, double speed_mps) {
  MirrorDriveConfig config;
  config.start_x_m = -from_m;
  config.speed_mps = speed_mps;
  return config;
}

TEST(Drops, OfStairsAreSeenAtTwoMetres) {
  const bench::Scene scene = bench::make_scene(SceneKind::kStairs, 3);
  const MirrorDrive drive(scene.world, towards_the_edge(5.0, 0.5));
  ObstacleScan last;
  drive_on(drive, 6.0, true, [&](const ObstacleScan& scan, double) { last = scan; });
  EXPECT_GT(drops_of(last), 3);
  EXPECT_LE(last.ground_seen_to_m[0], 2.3F);
}

TEST(Drops, OfHolesAndKerbsAreSeenAMetreBeforeThem) {
  for (const SceneKind kind : {SceneKind::kHole, SceneKind::kKerb}) {
    const bench::Scene scene = bench::make_scene(kind, 2);
    const MirrorDrive drive(scene.world, towards_the_edge(2.7, 0.5));
    ObstacleScan last;
    drive_on(drive, 3.4, true, [&](const ObstacleScan& scan, double) { last = scan; });
    EXPECT_GT(drops_of(last), 0) << bench::name_of(kind);
    EXPECT_LE(last.ground_seen_to_m[0], 1.3F) << bench::name_of(kind);
  }
}

// The floor between two low boxes that stand side by side is no hole between them.
TEST(Drops, AreNotTheFloorBetweenBoxes) {
  const bench::SlabWorld world =
      bench::flat_with({bench::block({1.6, 0.2, 0.0}, {2.0, 1.2, 0.08}),
                        bench::block({1.6, -1.2, 0.0}, {2.0, -0.2, 0.08})});
  const MirrorDrive drive(world, towards_the_edge(2.0, 0.4));
  drive_on(drive, 3.0, true,
           [&](const ObstacleScan& scan, double t_s) { EXPECT_EQ(drops_of(scan), 0) << t_s; });
}

TEST(Drops, AreNoneOnFlatFloorAndOnARamp) {
  for (const SceneKind kind : {SceneKind::kFlat, SceneKind::kRampUp}) {
    const bench::Scene scene = bench::make_scene(kind, 1);
    const MirrorDrive drive(scene.world, towards_the_edge(2.0, 1.0));
    double reach_m = 0.0;
    drive_on(drive, 5.0, true, [&](const ObstacleScan& scan, double t_s) {
      EXPECT_EQ(drops_of(scan), 0) << bench::name_of(kind) << " at " << t_s;
      reach_m = std::max(reach_m, static_cast<double>(scan.ground_seen_to_m[0]));
    });
    EXPECT_GT(reach_m, 2.0) << bench::name_of(kind);
  }
}

// The scanner looks elsewhere for most of a sweep, and the robot hides the floor beside it.
TEST(GroundSeen, StaysWhileOdometryMovesWhatWasSeen) {
  const bench::Scene scene = bench::make_scene(SceneKind::kFlat, 1);
  const MirrorDrive drive(scene.world, towards_the_edge(5.0, 0.3));
  double least_m = 9.0;
  drive_on(drive, 4.0, true, [&](const ObstacleScan& scan, double t_s) {
    if (t_s > 2.0) least_m = std::min(least_m, static_cast<double>(scan.ground_seen_to_m[0]));
  });
  EXPECT_GT(least_m, 1.5);
}

TEST(GroundSeen, IsForgottenWithoutOdometry) {
  const bench::Scene scene = bench::make_scene(SceneKind::kFlat, 1);
  const MirrorDrive drive(scene.world, towards_the_edge(5.0, 0.0));
  ObstacleFinder finder{ObstacleConfig{}};
  ObstacleScan last;
  drive_on(drive, 2.0, false, [&](const ObstacleScan& scan, double) { last = scan; });
  EXPECT_GT(last.ground_seen_to_m[0], 1.5F);
  EXPECT_TRUE(last.moving.empty());
  for (double t_s = 0.07; t_s < 2.0; t_s += 0.07) finder.take(drive.slice(t_s), {});
  Cloud empty;
  empty.utime_us = 4'000'000;
  EXPECT_EQ(finder.take(empty, ObstacleFinder::Part::kSlice).ground_seen_to_m[0], 0.0F);
}

// Four legs of 2.5 cm, 1.5 m ahead.
TEST(Obstacles, AreChairLegsThatABeamMetOnce) {
  std::vector<bench::Slab> legs;
  for (const double x : {1.5, 1.9})
    for (const double y : {-0.2, 0.2})
      legs.push_back(bench::block({x, y, 0.0}, {x + 0.025, y + 0.025, 0.45}));
  const bench::SlabWorld world = bench::flat_with(legs);
  const MirrorDrive drive(world, towards_the_edge(0.0, 0.0));
  ObstacleScan last;
  drive_on(drive, 2.5, true, [&](const ObstacleScan& scan, double) { last = scan; });
  for (const double y : {-0.2, 0.2}) {
    float nearest_m = 9.0F;
    for (const ObstacleCell& cell : last.cells)
      nearest_m =
          std::min(nearest_m, (cell.centre - Eigen::Vector2f(1.5F, static_cast<float>(y))).norm());
    EXPECT_LT(nearest_m, 0.15F) << y;
  }
}

// A person-sized box that walks by, 2 m ahead; the walls of the corridor stand.
TEST(MovingObstacles, AreToldWithTheirVelocityOverGround) {
  ObstacleFinder finder{ObstacleConfig{}};
  int told = 0, came = 0;
  for (double t_s = MirrorDrive::kSlice_s; t_s < 5.5; t_s += MirrorDrive::kSlice_s) {
    const double y = -2.5 + 0.8 * t_s;
    const bench::SlabWorld world =
        bench::flat_with({bench::block({1.9, y, 0.0}, {2.2, y + 0.4, 1.7})});
    MirrorDriveConfig config = towards_the_edge(1.0, 0.2);
    config.rocking_rad = 0.0;
    const MirrorDrive drive(world, config);
    finder.add_odometry({std::llround((t_s - 0.02) * 1e6), drive.T_odom_base(t_s - 0.02)});
    finder.add_odometry({std::llround(t_s * 1e6), drive.T_odom_base(t_s)});
    for (const MovingObstacle& moving :
         finder.take(drive.slice(t_s), ObstacleFinder::Part::kSlice).moving) {
      // It is told as soon as it has come, though its velocity is not known yet.
      if (moving.velocity_mps.isZero()) {
        ++came;
        continue;
      }
      EXPECT_NEAR(moving.velocity_mps.y(), 0.8, 0.2) << t_s;
      EXPECT_NEAR(moving.velocity_mps.x(), 0.0, 0.2) << t_s;
      EXPECT_NEAR(moving.position.y(), -2.3 + 0.8 * t_s, 0.5) << t_s;
      ++told;
    }
  }
  EXPECT_GT(told, 5);
  EXPECT_GT(came, 5);
}

}  // namespace
}  // namespace voxlist::planning
