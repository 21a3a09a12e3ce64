#include "voxlist/matching/localisation/scan_motion.h"

#include <gtest/gtest.h>

#include "voxlist/simulation/building/building.h"
#include "voxlist/simulation/scanner/ideal_sweep.h"

namespace voxlist::matching {
namespace {

Cloud scan_at(int building_seed, const Pose2& pose) {
  simulation::BuildingConfig config;
  config.seed = building_seed;
  const simulation::World world(simulation::make_building(config), {});
  const simulation::Trajectory still(1.0, {pose});
  return simulation::scan_sweep(simulation::MirrorScanner(world, still, {}, 1), still, 1.0, {}, 1);
}

const PoseWindow kWindow{{}, 1.5, 1.5, 0.5};

TEST(ScanMotion, IsWhatTheRobotMovedBetweenTwoScans) {
  const Pose2 motion{0.6, 0.1, 0.2}, start{1.0, 0.1, 0.3};
  const Cloud now = scan_at(1, start * motion);
  const auto found = scan_motion(scan_at(1, start), PreparedScan(now), kWindow, {});
  ASSERT_TRUE(found);
  EXPECT_LT(distance_m(*found, motion), 0.05);
  EXPECT_LT(turn_rad(*found, motion), 0.01);
}

TEST(ScanMotion, IsNothingWithoutPointsToGoBy) {
  const Cloud scan = scan_at(1, {}), nothing;
  EXPECT_FALSE(scan_motion(nothing, PreparedScan(scan), kWindow, {}));
  EXPECT_FALSE(scan_motion(scan, PreparedScan(nothing), kWindow, {}));
}

// Two scans of the same place, seen in headings that the window does not reach.
TEST(ScanMotion, IsNothingWhereScansDoNotFitTogether) {
  const Pose2 start{1.0, 0.1, 0.3}, turned{0.0, 0.0, 0.7};
  const Cloud before = scan_at(1, start), now = scan_at(1, start * turned);
  EXPECT_TRUE(scan_motion(before, PreparedScan(now), {{}, 0.3, 0.3, 0.8}, {}));
  EXPECT_FALSE(scan_motion(before, PreparedScan(now), {{}, 0.3, 0.3, 0.1}, {}));
}

}  // namespace
}  // namespace voxlist::matching
