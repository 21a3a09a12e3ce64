// The follower of tests/clients drives through a simulated building by what the obstacle detector
// tells it. tests/bench/README.md tells of hundreds of such drives.
#include "tests/bench/follow/followed_drive.h"

#include <gtest/gtest.h>

namespace voxlist::bench {
namespace {

// A building on which nothing was chosen (see tests/bench/README.md).
constexpr int kSeed = 173;

FollowedDriveResult drive(FollowedDriveConfig config) {
  config.seed = kSeed;
  config.laser = FollowersLaser::kMirror;
  return follow(config);
}

TEST(FollowedDrive, TouchesNobodyWhoStepsOntoItsWay) {
  const FollowedDriveResult met = drive({.step_in_every_m = 1.0, .longest_s = 8.0});
  EXPECT_GT(met.stepped_in, 0);
  EXPECT_GT(met.way_m, 1.0);
  EXPECT_FALSE(met.touched);
  EXPECT_GT(met.nearest_m, 0.0);
}

TEST(FollowedDrive, StopsWhenObstaclesStopOrSayThatNothingIsSeen) {
  const FollowedDriveResult silent = drive(
                                {.step_in_every_m = 0.0, .longest_s = 5.0, .silent_from_s = 2.0}),
                            blind = drive(
                                {.step_in_every_m = 0.0, .longest_s = 5.0, .blind_from_s = 2.0});
  for (const FollowedDriveResult& stopped : {silent, blind}) {
    EXPECT_FALSE(stopped.touched);
    EXPECT_GT(stopped.way_m, 0.5);
  }
  // It may notice after 0.3 s, and brakes for a second.
  EXPECT_GT(silent.stood_after_s, 0.1);
  EXPECT_LT(silent.stood_after_s, 1.4);
  EXPECT_LT(blind.stood_after_s, 1.2);
}

}  // namespace
}  // namespace voxlist::bench
