#include "voxlist/geometry/tilt.h"

#include <gtest/gtest.h>

#include "voxlist/geometry/angle.h"

namespace voxlist {
namespace {

TEST(Tilt, AndThePlanarPoseAreTheWholePose) {
  const Pose2 planar{1.0, -2.0, 2.5};
  const Tilt tilt{0.3, 0.2, -0.4};
  const Pose3 T = to_pose3(planar, tilt);
  EXPECT_NEAR(turn_rad(to_pose2(T), planar), 0.0, 1e-12);
  EXPECT_EQ(to_pose2(T).x_m, 1.0);
  EXPECT_NEAR(tilt_of(T).z_m, 0.3, 1e-12);
  EXPECT_NEAR(tilt_of(T).roll_rad, 0.2, 1e-12);
  EXPECT_NEAR(tilt_of(T).pitch_rad, -0.4, 1e-12);
}

TEST(Tilt, OfAPlanarPoseIsNoneAndItsPoseTheSameBits) {
  const Pose2 planar{1.0, -2.0, 2.5};
  EXPECT_EQ(tilt_of(to_pose3(planar)), Tilt{});
  EXPECT_TRUE(to_pose3(planar, {}).isApprox(to_pose3(planar), 0.0));
}

TEST(Tilt, LeansByRollAndPitchTogether) {
  EXPECT_NEAR(lean_rad({5.0, 6.0 * kRadPerDeg, -8.0 * kRadPerDeg}), 9.98 * kRadPerDeg, 2e-4);
  EXPECT_EQ(lean_rad({5.0, 0.0, 0.0}), 0.0);
}

// A base that is pitched by a quarter turn looks down along z.
TEST(Tilt, TakesPointsAndTheStartsOfRaysAlong) {
  Cloud cloud{7, {{1.0F, 0.0F, 0.0F}}, {}};
  const Cloud low = moved(to_level(Tilt{0.5, 0.0, 90.0 * kRadPerDeg}), cloud);
  EXPECT_EQ(low.utime_us, 7);
  EXPECT_NEAR((low.points.at(0) - Eigen::Vector3f(0.0F, 0.0F, -0.5F)).norm(), 0.0, 1e-6);
  EXPECT_NEAR((low.origin(0) - Eigen::Vector3f(0.0F, 0.0F, 0.5F)).norm(), 0.0, 1e-6);
  EXPECT_TRUE(moved(to_level(Tilt{0.0, 0.1, 0.0}), cloud).origins.empty());
}

}  // namespace
}  // namespace voxlist
