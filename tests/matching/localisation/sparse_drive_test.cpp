// Drives with a laser of few rings: what the scans cannot tell comes from the motion or is not
// claimed, and a bad scan costs itself alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "voxlist/matching/localisation/localiser.h"
#include "voxlist/simulation/random.h"

namespace voxlist::matching {
namespace {

constexpr double kLaser_m = 1.0, kHigh_m = 2.6, kNoise_m = 0.01, kStep_m = 0.5;

// A box about the map's origin, seen from base at x, by so many rings of 360 rays.
Cloud scan_in_box(const Eigen::Vector3d& half, double x, int rings, double range_m,
                  simulation::Random& random) {
  Cloud cloud;
  const Eigen::Vector3d laser(x, 0.0, kLaser_m), low(-half.x(), -half.y(), 0.0),
      high(half.x(), half.y(), kHigh_m);
  for (int i = 0; i < rings * 360; ++i) {
    const double up = (-25.0 + 50.0 * (i / 360 + 0.5) / rings) * std::numbers::pi / 180.0,
                 turn = (i % 360) * std::numbers::pi / 180.0;
    const Eigen::Vector3d way(std::cos(up) * std::cos(turn), std::cos(up) * std::sin(turn),
                              std::sin(up));
    double far_m = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      const double wall = way(axis) > 0.0 ? high(axis) : low(axis);
      if (way(axis) != 0.0) far_m = std::min(far_m, (wall - laser(axis)) / way(axis));
    }
    if (far_m > range_m) continue;
    const Eigen::Vector3d end = laser + (far_m + kNoise_m * random.normal()) * way;
    cloud.points.emplace_back((end - Eigen::Vector3d(x, 0.0, 0.0)).cast<float>());
    cloud.origins.emplace_back(0.0F, 0.0F, static_cast<float>(kLaser_m));
  }
  return cloud;
}

const Eigen::Vector3d kCorridor(100.0, 1.0, 0.0), kRoom(9.0, 4.0, 0.0);

// A localiser with the map that its own TRACKING scans make.
struct Mapping {
  OccupancyMap map;
  Localiser localiser{map};
  std::int64_t utime_us = 0;

  Localisation add(Cloud cloud, const std::optional<Pose2>& T_odom_base) {
    cloud.utime_us = utime_us += 1'000'000;
    const Localisation result = localiser.localise(cloud, T_odom_base);
    if (result.tracking())
      localiser.map_changed(add_scan(cloud, to_pose3(result.modes.front().T_map_base), 100.0, map));
    return result;
  }
};

TEST(SparseDrive, FollowsOdometryAlongABareCorridor) {
  constexpr int kRings = 16;
  simulation::Random random(1);
  Mapping mapping;
  double sigma_m = 0.0;
  for (int i = 0; i < 20; ++i) {
    const Pose2 truth{kStep_m * i, 0.0, 0.0};
    const auto result = mapping.add(scan_in_box(kCorridor, truth.x_m, kRings, 30.0, random), truth);
    ASSERT_TRUE(result.tracking()) << "scan " << i;
    EXPECT_LT(distance_m(result.modes.front().T_map_base, truth), 0.1) << "scan " << i;
    const double now_m = std::sqrt(result.modes.front().covariance(0, 0));
    EXPECT_GE(now_m, sigma_m) << "nothing tells how far it went";
    sigma_m = now_m;
  }
}

Cloud noise(simulation::Random& random) {
  Cloud cloud;
  for (int i = 0; i < 3000; ++i)
    cloud.points.emplace_back(random.uniform(-8.0, 8.0), random.uniform(-4.0, 4.0),
                              random.uniform(0.0, 2.6));
  return cloud;
}

// By odometry: a box looks the same turned by half a circle.
TEST(SparseDrive, LosesOneScanByABadOne) {
  simulation::Random random(3);
  Mapping mapping;
  for (int i = 0; i < 12; ++i) {
    const bool bad = i == 3 || i == 7;
    const Pose2 truth{-3.0 + 0.3 * i, 0.0, 0.0};
    const auto result =
        mapping.add(bad ? noise(random) : scan_in_box(kRoom, truth.x_m, 25, 30.0, random), truth);
    ASSERT_EQ(result.tracking(), !bad) << "scan " << i;
    if (bad) continue;
    EXPECT_NEAR(result.modes.front().T_map_base.x_m, 0.3 * i, 0.05) << "scan " << i;
  }
}

}  // namespace
}  // namespace voxlist::matching
