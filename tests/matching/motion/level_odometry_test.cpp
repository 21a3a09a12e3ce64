#include "voxlist/matching/motion/level_odometry.h"

#include <gtest/gtest.h>

#include <cmath>

namespace voxlist::matching {
namespace {

TEST(LevelOdometry, AWayUphillIsShorterFromAbove) {
  LevelOdometry odometry;
  odometry.note({1.0, 2.0, 0.0}, {});
  const Tilt uphill{0.0, 0.0, -0.2};
  const Pose2 seen = odometry.seen_from_above({2.0, 2.0, 0.0}, uphill);
  EXPECT_NEAR(seen.x_m, 1.0 + std::cos(0.2), 1e-12);
  EXPECT_DOUBLE_EQ(seen.y_m, 2.0);
}

TEST(LevelOdometry, GoesOnFromWhereItWas) {
  LevelOdometry odometry;
  const Tilt uphill{0.0, 0.0, -0.2};
  odometry.note({0.0, 0.0, 0.0}, {});
  odometry.note({1.0, 0.0, 0.0}, uphill);
  EXPECT_NEAR(odometry.seen_from_above({2.0, 0.0, 0.0}, {}).x_m, 1.0 + std::cos(0.2), 1e-12);
}

TEST(LevelOdometry, IsAsItIsWhereTheFloorIsLevel) {
  LevelOdometry odometry;
  odometry.note({1.0, 2.0, 0.5}, {});
  const Pose2 seen = odometry.seen_from_above({3.0, 1.0, 0.7}, {});
  EXPECT_NEAR(seen.x_m, 3.0, 1e-12);
  EXPECT_NEAR(seen.y_m, 1.0, 1e-12);
  EXPECT_NEAR(seen.yaw_rad, 0.7, 1e-12);
}

}  // namespace
}  // namespace voxlist::matching
