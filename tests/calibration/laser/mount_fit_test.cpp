#include "voxlist/calibration/laser/mount_fit.h"

#include <gtest/gtest.h>

#include <functional>

#include "voxlist/geometry/angle.h"
#include "voxlist/simulation/random.h"

namespace voxlist::calibration {
namespace {

constexpr std::int64_t kStart_us = 1'700'000'000'000'000;

// Speed (m/s) and turn rate (rad/s) at a time.
using Drive = std::function<std::pair<double, double>(double t_s)>;

Pose2 step(const Drive& drive, double t_s, double dt_s) {
  const auto [speed_mps, rate_radps] = drive(t_s);
  return {speed_mps * dt_s, 0.0, rate_radps * dt_s};
}

// A minute of it, scanned at 10 Hz by a laser whose times are late, with noise.
LaserDrive driven(const Drive& drive, const Pose2& T_base_assumed, double late_s) {
  simulation::Random random(3);
  LaserDrive told;
  Pose2 T_map_base, T_odom_base;
  constexpr double kStep_s = 0.001;
  for (int i = 0; i < 62'000; ++i) {
    const std::int64_t utime_us = kStart_us + i * 1000;
    if (i % 20 == 0) told.odometry.push_back({utime_us, T_odom_base});
    if (i % 100 == 0) {
      const Pose2 noise{0.004 * random.normal(), 0.004 * random.normal(), 0.001 * random.normal()};
      told.scans.push_back(
          {utime_us + std::llround(late_s * 1e6), T_map_base * T_base_assumed * noise});
    }
    const Pose2 motion = step(drive, i * kStep_s, kStep_s);
    T_map_base = T_map_base * motion;
    T_odom_base = T_odom_base * Pose2{1.01 * motion.x_m, 0.0, 0.99 * motion.yaw_rad};
  }
  return told;
}

std::pair<double, double> curves(double t_s) {
  const bool turns = std::fmod(t_s, 4.0) > 2.0;
  const double side = std::fmod(t_s, 8.0) > 4.0 ? 1.0 : -1.0;
  return {turns ? 0.3 : 0.9, turns ? side * 0.8 : 0.0};
}

TEST(MountFit, FindsMountAndLatencyWhateverTheyAre) {
  for (const Pose2& mount : {Pose2{0.3, -0.2, 0.5}, Pose2{-0.4, 0.1, 3.0}, Pose2{0.0, 0.0, -1.7}}) {
    const auto fit = fit_mount(driven(curves, mount, 0.02));
    ASSERT_TRUE(fit);
    EXPECT_NEAR(fit->correction[kMountX], mount.x_m, 0.01);
    EXPECT_NEAR(fit->correction[kMountY], mount.y_m, 0.01);
    EXPECT_NEAR(wrap_angle(fit->correction[kMountYaw] - mount.yaw_rad), 0.0, 0.15 * kRadPerDeg);
    EXPECT_NEAR(fit->correction[kMountLatency], 0.02, 0.002);
    EXPECT_LT(fit->sd[kMountX], 0.01);
    EXPECT_LT(fit->sd[kMountYaw], 0.1 * kRadPerDeg);
    EXPECT_LT(fit->sd[kMountLatency], 0.0015);
    EXPECT_GT(fit->motions, 40u);
  }
}

TEST(MountFit, IsNotSureOfWhatTheDriveDoesNotTell) {
  const auto straight = fit_mount(driven(
      [](double) {
        return std::pair{0.8, 0.0};
      },
      {0.3, 0.2, 0.5}, 0.0));
  ASSERT_TRUE(straight);
  EXPECT_NEAR(straight->correction[kMountYaw], 0.5, 0.2 * kRadPerDeg);
  EXPECT_LT(straight->sd[kMountYaw], 0.1 * kRadPerDeg);
  EXPECT_GT(straight->sd[kMountX], 0.1);
  EXPECT_GT(straight->sd[kMountY], 0.1);
  EXPECT_GT(straight->sd[kMountLatency], 0.01);
  const auto standing = fit_mount(driven(
      [](double) {
        return std::pair{0.0, 0.0};
      },
      {0.3, 0.2, 0.5}, 0.0));
  ASSERT_TRUE(standing);
  EXPECT_GT(standing->sd[kMountYaw], 0.1);
}

TEST(MountFit, NeedsOdometryOfTheSameTime) {
  LaserDrive drive = driven(curves, {0.3, -0.2, 0.5}, 0.0);
  for (StampedPose2& pose : drive.odometry) pose.utime_us += 3'600'000'000;
  EXPECT_FALSE(fit_mount(drive));
  EXPECT_FALSE(fit_mount({}));
}

}  // namespace
}  // namespace voxlist::calibration
