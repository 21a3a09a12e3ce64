#include "voxlist/simulation/world/trajectory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "voxlist/system/check.h"

namespace voxlist::simulation {
namespace {

TEST(Trajectory, InterpolatesAndHoldsItsEnds) {
  const Trajectory trajectory(0.5, {{1.0, 0.0, 3.0}, {2.0, 4.0, -3.0}});
  EXPECT_DOUBLE_EQ(trajectory.duration_s(), 0.5);
  EXPECT_DOUBLE_EQ(trajectory.at(0.25).x_m, 1.5);
  EXPECT_DOUBLE_EQ(trajectory.at(0.25).y_m, 2.0);
  EXPECT_NEAR(std::abs(trajectory.at(0.25).yaw_rad), std::numbers::pi, 1e-9) << "the short way";
  EXPECT_DOUBLE_EQ(trajectory.at(-1.0).x_m, 1.0);
  EXPECT_DOUBLE_EQ(trajectory.at(9.0).x_m, 2.0);
}

#if VOXLIST_CHECKS
TEST(TrajectoryDeathTest, HasAtLeastOnePose) {
  EXPECT_DEATH(Trajectory(0.5, {}), "at least one pose");
}
#endif

}  // namespace
}  // namespace voxlist::simulation
