// The promise to planners: whoever plans in what we export finds a way where there is one, touches
// nothing, and goes nowhere that nobody saw. The planners are those of tests/clients.
#include <gtest/gtest.h>

#include "tests/bench/paths/octomap_paths.h"

namespace voxlist::bench {
namespace {

// A building on which nothing was chosen (see tests/bench/README.md).
constexpr int kSeed = 171, kErrands = 3;

void expect_kept(const PathTally& tally) {
  EXPECT_EQ(tally.errands, kErrands);
  EXPECT_GT(tally.ways, 0);
  EXPECT_EQ(tally.missed, 0);
  EXPECT_GE(tally.found, tally.ways);
  EXPECT_EQ(tally.collided, 0);
  EXPECT_EQ(tally.through_unknown, 0);
}

TEST(PathInAnExportedOctoMap, OfALowRobotTouchesNothingAndIsKnown) {
  expect_kept(plan_in_octomap(kSeed, kErrands, kLowRobot));
}

TEST(PathInAnExportedOctoMap, OfATallRobotTouchesNothingAndIsKnown) {
  expect_kept(plan_in_octomap(kSeed, kErrands, kTallRobot));
}

}  // namespace
}  // namespace voxlist::bench
