#include "matching/scan_motion.h"

#include <gtest/gtest.h>

#include "simulation/building.h"
#include "simulation/ideal_sweep.h"

namespace voxlist {
namespace {

Cloud scan_at(int building_seed, const Pose2& pose) {
  BuildingConfig config;
  config.seed = building_seed;
  const World world(make_building(config), {});
  const Trajectory still(1.0, {pose});
  return scan_sweep(MirrorScanner(world, still, {}, 1), still, 1.0, {}, 1);
}

const PoseWindow kWindow{{}, 1.5, 1.5, 0.5};

TEST(ScanMotion, IsWhatTheRobotMovedBetweenTwoScans) {
  const Pose2 motion{0.6, 0.1, 0.2}, start{1.0, 0.1, 0.3};
  const auto found = scan_motion(scan_at(1, start), scan_at(1, start * motion), kWindow, {});
  ASSERT_TRUE(found);
  EXPECT_LT(distance_m(*found, motion), 0.05);
  EXPECT_LT(turn_rad(*found, motion), 0.01);
}

TEST(ScanMotion, IsNothingWithoutPointsToGoBy) {
  EXPECT_FALSE(scan_motion(Cloud{}, scan_at(1, {}), kWindow, {}));
  EXPECT_FALSE(scan_motion(scan_at(1, {}), Cloud{}, kWindow, {}));
}

}  // namespace
}  // namespace voxlist
