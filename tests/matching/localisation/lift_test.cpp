// A robot that a lift carries to a floor of the same shape.
#include <gtest/gtest.h>

#include <cmath>

#include "voxlist/matching/localisation/localiser.h"
#include "voxlist/simulation/building/building.h"
#include "voxlist/simulation/scanner/ideal_sweep.h"

namespace voxlist::matching {
namespace {

constexpr double kUpper_m = 4.0;

// Two floors of one shape; later, furniture was moved.
const simulation::World& building(bool is_furnished_otherwise) {
  static const simulation::World plain(simulation::make_building({.seed = 1}), {}),
      other(simulation::make_building({.seed = 1, .changed = 1}), {});
  return is_furnished_otherwise ? other : plain;
}

// In the middle of a room, facing along it.
Pose2 place(double way_m) {
  static const simulation::Room room = simulation::make_building({.seed = 1}).rooms.front();
  return Pose2{room.centre().x() - 0.4, room.centre().y(), 0.2} * Pose2{way_m, 0.0, 0.0};
}

Cloud scan_at(const Pose2& pose, bool is_furnished_otherwise) {
  const simulation::Trajectory still(2.0, {pose});
  simulation::IdealSweepConfig config;
  config.lines_per_second = 200;
  return simulation::scan_sweep(
      simulation::MirrorScanner(building(is_furnished_otherwise), still, {}, 1), still, 1.0, config,
      1);
}

void add_floor(double height_m, bool is_furnished_otherwise, OccupancyMap& map) {
  for (int i = 0; i < 4; ++i)
    add_scan(scan_at(place(0.25 * i), is_furnished_otherwise),
             to_pose3(place(0.25 * i), {height_m, 0.0, 0.0}), 100.0, map);
}

// A robot whose wheels are right, on the lower floor, of which alone it knew when it began.
class Robot {
 public:
  explicit Robot(bool is_furnished_otherwise)
      : is_furnished_otherwise_(is_furnished_otherwise), localiser_(map_, config()) {
    add_floor(0.0, false, map_);
    EXPECT_TRUE(scan(0.0, 0.05, false).tracking());
    add_floor(kUpper_m, is_furnished_otherwise, map_);
  }

  Localisation scan(double seconds, double way_m, bool is_above) {
    Cloud cloud = scan_at(place(way_m), is_above && is_furnished_otherwise_);
    cloud.utime_us = std::llround(1e6 * seconds);
    return localiser_.localise(cloud, Pose2{way_m, 0.0, 0.0});
  }

 private:
  static LocaliserConfig config() {
    LocaliserConfig config;
    config.tilt = TiltUse::kRefine;
    return config;
  }

  const bool is_furnished_otherwise_;
  OccupancyMap map_;
  Localiser localiser_;
};

double height_m(const Localisation& found) { return found.modes.front().tilt.z_m; }

TEST(Lift, ARobotIsFollowedOnTheFloorThatItWasCarriedTo) {
  Robot robot(true);
  EXPECT_TRUE(robot.scan(0.5, 0.15, false).tracking());
  Localisation found;
  for (int i = 0; i < 10; ++i) {
    found = robot.scan(1.0 + 0.5 * i, 0.2 + 0.1 * i, true);
    const bool is_claimed_below = found.tracking() && height_m(found) < kUpper_m - 0.05;
    EXPECT_FALSE(is_claimed_below) << i;
  }
  ASSERT_TRUE(found.tracking());
  EXPECT_LT(distance_m(found.modes.front().T_map_base, place(1.1)), 0.03);
}

TEST(Lift, FloorsThatAreTheSameDoNotStopADrive) {
  Robot robot(false);
  for (int i = 0; i < 6; ++i) {
    const Localisation found = robot.scan(0.5 + 0.5 * i, 0.1 + 0.1 * i, false);
    ASSERT_TRUE(found.tracking()) << i;
    EXPECT_NEAR(height_m(found), 0.0, 0.05) << i;
  }
}

TEST(Lift, AfterATimeWithoutScansFloorsThatAreTheSameAreBothTold) {
  Robot robot(false);
  EXPECT_TRUE(robot.scan(0.5, 0.1, false).tracking());
  const Localisation found = robot.scan(10.0, 0.15, true);
  EXPECT_EQ(found.state, LocalisationState::kAmbiguous);
  ASSERT_GE(found.modes.size(), 2U);
  EXPECT_NEAR(found.modes[0].tilt.z_m + found.modes[1].tilt.z_m, kUpper_m, 0.05);
  EXPECT_GT(found.modes[1].probability, 0.1);
}

}  // namespace
}  // namespace voxlist::matching
