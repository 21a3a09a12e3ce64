#include "voxlist/planning/stopping/safe_speed.h"

#include <gtest/gtest.h>

#include <cmath>

namespace voxlist::planning {
namespace {

constexpr int kSectors = 360;

// Floor as far as one sees, and a scanner that is quick enough for any speed.
Surroundings free_floor() {
  Surroundings around;
  around.ground_seen_to_m.assign(kSectors, 10.F);
  around.step_rad = 2.0 * M_PI / kSectors;
  around.sweep_s = 0.0;
  return around;
}

double speed(const Surroundings& around, double turn_radps = 0.0) {
  return safe_speed_mps(around, turn_radps, {});
}

TEST(SafeSpeed, IsTheTopSpeedWhereAllIsFree) { EXPECT_DOUBLE_EQ(speed(free_floor()), 1.0); }

TEST(SafeSpeed, LeavesRoomToStopBeforeAWall) {
  for (const double wall_m : {0.5, 0.8, 1.2}) {
    Surroundings around = free_floor();
    around.things.push_back({{wall_m, 0.0}});
    const double v = speed(around);
    ASSERT_GT(v, 0.1);
    const StoppingRobot robot;
    const double stops_m = robot.reaction_s * v + v * v / (2.0 * robot.brakes_mps2);
    EXPECT_LT(robot.radius_m + stops_m, wall_m);
    EXPECT_GT(v, stopping_speed_mps(wall_m - 0.45, 0.2, 1.0) - 0.1);
  }
}

TEST(SafeSpeed, IsLessTheOlderTheLookIs) {
  Surroundings around = free_floor();
  around.things.push_back({{1.0, 0.0}});
  const double fresh = speed(around);
  around.age_s = 0.3;
  EXPECT_LT(speed(around), fresh);
}

TEST(SafeSpeed, IsLessTheLongerASweepTakes) {
  Surroundings around = free_floor();
  around.sweep_s = 0.1;
  EXPECT_DOUBLE_EQ(speed(around), 1.0);
  around.sweep_s = 1.0;
  const double slow = speed(around), late_s = 1.15;
  EXPECT_LT(slow * late_s + slow * slow / 2.0, around.steps_in_m - 0.3);
  EXPECT_GT(slow, 0.8);
}

TEST(SafeSpeed, EndsWhereTheFloorDoes) {
  Surroundings around = free_floor();
  around.ground_seen_to_m.assign(kSectors, 0.29F);
  EXPECT_EQ(speed(around), 0.0);
  around.ground_seen_to_m.assign(kSectors, 0.6F);
  EXPECT_GT(speed(around), 0.3);
  EXPECT_LT(speed(around), 0.8);
}

TEST(SafeSpeed, MindsTheFloorOnItsOwnWayAlone) {
  Surroundings around = free_floor();
  for (int sector = 60; sector < 300; ++sector)
    around.ground_seen_to_m[static_cast<std::size_t>(sector)] = 0.F;
  EXPECT_DOUBLE_EQ(speed(around), 1.0);
}

TEST(SafeSpeed, IsSlowBesideAThingAndMayLeaveIt) {
  Surroundings beside = free_floor();
  beside.things.push_back({{0.3, 0.36}});
  EXPECT_GT(speed(beside), 0.1);
  EXPECT_LT(speed(beside), 0.6);
  Surroundings behind = free_floor();
  behind.things.push_back({{-0.31, 0.0}});
  EXPECT_DOUBLE_EQ(speed(behind), 1.0);
}

TEST(SafeSpeed, FollowsTheTurn) {
  Surroundings around = free_floor();
  around.things.push_back({{0.5, 0.5}});
  EXPECT_DOUBLE_EQ(speed(around), 1.0);
  EXPECT_LT(speed(around, 1.0), 0.9);
}

TEST(SafeSpeed, WaitsForWhomeverMayComeNearer) {
  Surroundings around = free_floor();
  Thing person{{1.0, 0.9}, 0.25};
  around.things = {person};
  EXPECT_DOUBLE_EQ(speed(around), 1.0);
  person.strays_mps = 1.2;
  around.things = {person};
  EXPECT_LT(speed(around), 0.9);
  person.strays_mps = 0.0;
  person.velocity_mps = {0.0, -1.2};
  around.things = {person};
  EXPECT_LT(speed(around), 0.9);
  person.velocity_mps = {0.0, 1.2};
  around.things = {person};
  EXPECT_DOUBLE_EQ(speed(around), 1.0);
}

TEST(StoppingSpeed, StandsWithinTheGap) {
  EXPECT_EQ(stopping_speed_mps(0.0, 0.5, 1.0), 0.0);
  EXPECT_EQ(stopping_speed_mps(-1.0, 0.5, 1.0), 0.0);
  const double v = stopping_speed_mps(2.0, 0.5, 1.2);
  EXPECT_NEAR(0.5 * v + v * v / 2.4, 2.0, 1e-9);
}

}  // namespace
}  // namespace voxlist::planning
