#include <gtest/gtest.h>

#include "voxlist/geometry/angle.h"
#include "voxlist/matching/localisation/localiser.h"
#include "voxlist/simulation/building/building.h"
#include "voxlist/simulation/scanner/ideal_sweep.h"

namespace voxlist::matching {
namespace {

const simulation::World& building(int seed) {
  static const simulation::World first(simulation::make_building({.seed = 1}), {}),
      second(simulation::make_building({.seed = 2}), {});
  return seed == 1 ? first : second;
}

// A level scan, with more lines than the mirror scanner's: one second is not enough for a floor.
Cloud scan_at(const Pose2& pose, int seed = 1) {
  const simulation::Trajectory still(2.0, {pose});
  simulation::IdealSweepConfig config;
  config.lines_per_second = 200;
  return simulation::scan_sweep(simulation::MirrorScanner(building(seed), still, {}, 1), still, 1.0,
                                config, 1);
}

Cloud seen_tilted(const Pose2& pose, const Tilt& tilt) {
  return moved(to_level(tilt).inverse(), scan_at(pose));
}

Pose2 place(int i) { return {0.9 + 0.25 * i, 0.1, 0.3 + 0.05 * i}; }

void add_floor(double height_m, int seed, OccupancyMap& map) {
  for (int i = 0; i < 4; ++i)
    add_scan(scan_at(place(i), seed), to_pose3(place(i), {height_m, 0.0, 0.0}), 100.0, map);
}

OccupancyMap map_of_places() {
  OccupancyMap map;
  add_floor(0.0, 1, map);
  return map;
}

LocaliserConfig config(TiltUse tilt) {
  LocaliserConfig config;
  config.tilt = tilt;
  return config;
}

void expect_near(const PoseMode& found, const Pose2& pose, const Tilt& tilt) {
  EXPECT_LT(distance_m(found.T_map_base, pose), 0.03);
  EXPECT_LT(turn_rad(found.T_map_base, pose), 0.3 * kRadPerDeg);
  EXPECT_NEAR(found.tilt.z_m, tilt.z_m, 0.03);
  EXPECT_NEAR(found.tilt.roll_rad, tilt.roll_rad, 0.3 * kRadPerDeg);
  EXPECT_NEAR(found.tilt.pitch_rad, tilt.pitch_rad, 0.3 * kRadPerDeg);
}

TEST(Tilted, ACloudIsFoundInTheWholeMapWithAllSixCoordinates) {
  const OccupancyMap map = map_of_places();
  const Tilt tilt{0.15, 3.0 * kRadPerDeg, -2.0 * kRadPerDeg};
  const Localisation found =
      Localiser(map, config(TiltUse::kRefine)).locate(seen_tilted(place(1), tilt));
  ASSERT_FALSE(found.modes.empty());
  expect_near(found.modes.front(), place(1), tilt);
}

TEST(Tilted, ARobotIsFollowedThatRollsPitchesAndHeaves) {
  const OccupancyMap map = map_of_places();
  Localiser localiser(map, config(TiltUse::kRefine));
  int tracked = 0;
  for (int i = 0; i < 4; ++i) {
    const Tilt tilt{0.03 * i, (2.0 - i) * kRadPerDeg, 1.5 * i * kRadPerDeg};
    Cloud cloud = seen_tilted(place(i), tilt);
    cloud.utime_us = 1'000'000 * i;
    const Localisation found = localiser.localise(cloud);
    if (!found.tracking()) continue;
    ++tracked;
    expect_near(found.modes.front(), place(i), tilt);
  }
  EXPECT_GE(tracked, 3);
}

TEST(Tilted, TheCloudThatBeginsAMapIsMadeLevel) {
  const OccupancyMap none;
  const Tilt tilt{0.0, 3.0 * kRadPerDeg, -6.0 * kRadPerDeg};
  const Localisation found =
      Localiser(none, config(TiltUse::kRefine)).localise(seen_tilted(place(0), tilt));
  ASSERT_TRUE(found.tracking());
  expect_near(found.modes.front(), {}, tilt);
}

// No floor in sight, and more tilt than from cloud to cloud: odometry alone knows.
TEST(Tilted, OdometrysRollAndPitchLevelACloudThatShowsNoFloor) {
  const OccupancyMap map = map_of_places();
  const auto without_floor = [](Cloud cloud, const Tilt& tilt) {
    Cloud rest{cloud.utime_us, {}, {}};
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
      if ((to_level(tilt) * cloud.points[i].cast<double>()).z() < 0.3) continue;
      rest.points.push_back(cloud.points[i]);
      rest.origins.push_back(cloud.origin(i));
    }
    return rest;
  };
  const Tilt tilt{0.05, 14.0 * kRadPerDeg, -14.0 * kRadPerDeg};
  const auto found_with = [&](TiltUse use) {
    Localiser localiser(map, config(use));
    EXPECT_TRUE(localiser.localise(scan_at(place(1))).tracking());
    Cloud cloud = without_floor(seen_tilted(place(2), tilt), tilt);
    cloud.utime_us = 1'000'000;
    return localiser.localise(cloud, std::nullopt, Tilt{0.0, tilt.roll_rad, tilt.pitch_rad});
  };
  const Localisation found = found_with(TiltUse::kOdometry);
  ASSERT_TRUE(found.tracking());
  expect_near(found.modes.front(), place(2), tilt);
  EXPECT_FALSE(found_with(TiltUse::kRefine).tracking());
}

TEST(Tilted, ACloudIsFoundOnTheFloorThatItIsOf) {
  OccupancyMap map = map_of_places();
  add_floor(4.0, 2, map);
  for (const auto& [height_m, seed] : {std::pair(0.0, 1), std::pair(4.0, 2)}) {
    const Localisation found =
        Localiser(map, config(TiltUse::kRefine)).locate(scan_at(place(1), seed));
    ASSERT_FALSE(found.modes.empty());
    expect_near(found.modes.front(), place(1), {height_m, 0.0, 0.0});
  }
}

TEST(Tilted, OfFloorsThatLookAlikeNoneIsClaimed) {
  OccupancyMap map = map_of_places();
  EXPECT_TRUE(Localiser(map, config(TiltUse::kRefine)).locate(scan_at(place(1))).tracking());
  add_floor(4.0, 1, map);
  const Localisation found = Localiser(map, config(TiltUse::kRefine)).locate(scan_at(place(1)));
  EXPECT_EQ(found.state, LocalisationState::kAmbiguous);
  ASSERT_FALSE(found.modes.empty());
  EXPECT_NEAR(found.modes.front().probability, 0.5, 0.01);
}

TEST(Tilted, TheMapsSurfacesCorrectWhatOdometrysPitchIsOffBy) {
  const OccupancyMap map = map_of_places();
  Localiser localiser(map, config(TiltUse::kOdometry));
  ASSERT_TRUE(localiser.localise(scan_at(place(1)), std::nullopt, Tilt{}).tracking());
  Cloud cloud = scan_at(place(2));
  cloud.utime_us = 1'000'000;
  const Tilt wrong{0.0, 0.0, 8.0 * kRadPerDeg};
  const Localisation found = localiser.localise(cloud, std::nullopt, wrong);
  ASSERT_TRUE(found.tracking());
  expect_near(found.modes.front(), place(2), {});
}

TEST(Tilted, PosesArePlanarWhereTheyAreAskedToBe) {
  const OccupancyMap map = map_of_places();
  const Localisation found = Localiser(map).locate(scan_at(place(1)));
  ASSERT_FALSE(found.modes.empty());
  EXPECT_EQ(found.modes.front().tilt, Tilt{});
}

}  // namespace
}  // namespace voxlist::matching
