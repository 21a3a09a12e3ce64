#include "voxlist/matching/scan/floor.h"

#include <gtest/gtest.h>

#include "voxlist/geometry/angle.h"
#include "voxlist/simulation/building/building.h"
#include "voxlist/simulation/scanner/ideal_sweep.h"

namespace voxlist::matching {
namespace {

// A scan at one of some places of a building, by a scanner whose mount is not told.
Cloud scan(const simulation::World& world, int place, const Tilt& mount) {
  const Pose2 pose{0.7 * place - 1.0, 0.3 * place - 0.9, 0.3 + place};
  const simulation::Trajectory still(1.0, {pose});
  return moved(
      to_level(mount).inverse(),
      simulation::scan_sweep(simulation::MirrorScanner(world, still, {}, 1), still, 1.0, {}, 1));
}

// The ground as `height` has it, 20 x 20 m, seen from 1 m above base.
template <class Height>
Cloud ground(const Height& height) {
  Cloud cloud;
  for (float x = -10.0F; x < 10.0F; x += 0.1F)
    for (float y = -10.0F; y < 10.0F; y += 0.1F) cloud.points.emplace_back(x, y, height(x, y));
  cloud.origins.assign(cloud.points.size(), {0.0F, 0.0F, 1.0F});
  return cloud;
}

TEST(Floor, OfAScannerThatIsNotLevelTellsItsMount) {
  const Tilt mounts[] = {
      {}, {0.61, 6.0 * kRadPerDeg, -7.8 * kRadPerDeg}, {-0.3, 0.0, 20.0 * kRadPerDeg}};
  int told = 0;
  for (int seed = 1; seed <= 3; ++seed) {
    simulation::BuildingConfig config;
    config.seed = seed;
    const simulation::World world(simulation::make_building(config), {});
    for (int place = 0; place < 4; ++place) {
      for (const Tilt& mount : mounts) {
        const auto floor = find_floor(scan(world, place, mount));
        if (!floor) continue;
        ++told;
        EXPECT_NEAR(floor->level.z_m, mount.z_m, 0.03) << seed << " " << place;
        EXPECT_NEAR(floor->level.roll_rad, mount.roll_rad, 0.5 * kRadPerDeg);
        EXPECT_NEAR(floor->level.pitch_rad, mount.pitch_rad, 0.5 * kRadPerDeg);
      }
    }
  }
  EXPECT_GE(told, 24) << "of 36";
}

TEST(Floor, IsNotToldWhereHalfOfTheGroundDisagrees) {
  const auto edge_at = [](float edge_m) {
    return ground([edge_m](float x, float) { return x < edge_m ? 0.0F : 0.4F * (x - edge_m); });
  };
  EXPECT_TRUE(find_floor(edge_at(6.0F))) << "a ramp, far away";
  EXPECT_FALSE(find_floor(ground([](float x, float y) { return 0.02F * (x * x + y * y); })));
  EXPECT_FALSE(find_floor(ground([](float x, float y) {
    return 0.4F * static_cast<float>(static_cast<int>(x + 20.0F) * static_cast<int>(y + 20.0F) % 5);
  })));
}

TEST(Floor, IsNeitherACeilingNorAWallNorNothing) {
  EXPECT_FALSE(find_floor(ground([](float, float) { return 2.5F; })));
  EXPECT_FALSE(find_floor(ground([](float x, float) { return 2.0F * x; })));
  EXPECT_FALSE(find_floor({}));
}

TEST(Floor, IsNamedWhereItIsOff) {
  Floor floor;
  EXPECT_EQ(what_is_off(floor), "");
  floor.level = {0.05, 0.02, 0.02};
  EXPECT_EQ(what_is_off(floor), "");
  floor.level = {0.61, 0.0, 9.8 * kRadPerDeg};
  EXPECT_EQ(what_is_off(floor), "floor tilted by 9.8 deg, 0.61 m low: is the mount set?");
  floor.level = {-0.2, 0.0, 0.0};
  EXPECT_EQ(what_is_off(floor), "floor 0.20 m high: is the mount set?");
}

}  // namespace
}  // namespace voxlist::matching
