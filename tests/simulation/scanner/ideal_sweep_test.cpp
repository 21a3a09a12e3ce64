#include "voxlist/simulation/scanner/ideal_sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "voxlist/simulation/world/robot.h"
#include "voxlist/simulation/world/tour.h"

namespace voxlist::simulation {
namespace {

constexpr double kDegPerRad = 180.0 / std::numbers::pi;
constexpr double kDriving = 20.0;  // s: the robot is under way

struct Scene {
  World world{make_building({})};
  Trajectory truth = drive(plan_tour(world.building(), {}), {});
  Trajectory still{1.0, {Pose2{}}};
  MirrorScanner driving{world, truth, {}, 1};
  MirrorScanner standing{world, still, {}, 1};

  Cloud sweep(double t_end_s, std::uint64_t seed = 1) const {
    return scan_sweep(driving, truth, t_end_s, {}, seed);
  }
};

// Root mean square and largest distance of a cloud's points from the building's surfaces.
struct Misfit {
  double rms_m = 0.0, max_m = 0.0;
};

Misfit misfit(const Building& building, const Pose2& T_map_base, const Cloud& cloud) {
  Misfit misfit;
  for (const Eigen::Vector3f& point : cloud.points) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Box& box : building.solid.boxes())
      nearest = std::min(nearest, box.surface_distance_m(T_map_base * point.cast<double>()));
    misfit.rms_m += nearest * nearest;
    misfit.max_m = std::max(misfit.max_m, nearest);
  }
  misfit.rms_m = std::sqrt(misfit.rms_m / static_cast<double>(cloud.points.size()));
  return misfit;
}

TEST(IdealSweep, PutsItsPointsOnSurfacesWithinItsNoiseWhileItDrives) {
  const Scene scene;
  const Cloud cloud = scene.sweep(kDriving);
  EXPECT_GT(cloud.points.size(), 4000u);
  EXPECT_LT(cloud.points.size(), 7000u);
  const Misfit found = misfit(scene.world.building(), scene.truth.at(kDriving), cloud);
  EXPECT_LE(found.rms_m, 0.015);
  EXPECT_GE(found.rms_m, 0.005);
  EXPECT_LE(found.max_m, 6.0 * 0.015 + 1e-5);
}

TEST(IdealSweep, SmearsTheWorldWhenTheMeasuredMotionIsWrong) {
  const Scene scene;
  const Cloud cloud = scan_sweep(scene.driving, scene.still, kDriving, {}, 1);
  EXPECT_GT(misfit(scene.world.building(), scene.truth.at(kDriving), cloud).rms_m, 0.05);
}

TEST(IdealSweep, StartsEveryRayOnTheMirrorNearItsAxis) {
  const Scene scene;
  const Cloud cloud = scan_sweep(scene.standing, scene.still, 1.0, {}, 1);
  ASSERT_EQ(cloud.origins.size(), cloud.points.size());
  float reach = 0.0F;
  for (const Eigen::Vector3f& origin : cloud.origins) {
    EXPECT_EQ(origin.x(), 0.0F);
    EXPECT_NEAR(origin.z(), 0.6, 0.002 / std::sin(7.5 / kDegPerRad) + 1e-6);
    reach = std::max(reach, std::abs(origin.y()));
  }
  EXPECT_NEAR(reach, 0.1 / std::tan(25.0 / kDegPerRad), 0.035);
}

TEST(IdealSweep, IsBlindUpwardsDownwardsAndBeyondItsRange) {
  const Scene scene;
  const Cloud cloud = scan_sweep(scene.standing, scene.still, 1.0, {}, 1);
  double up = 180.0, down = 180.0, range = 0.0;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const Eigen::Vector3d ray = (cloud.points[i] - cloud.origins[i]).cast<double>();
    const double from_up = std::abs(std::atan2(ray.x(), ray.z())) * kDegPerRad;
    up = std::min(up, from_up);
    down = std::min(down, 180.0 - from_up);
    const double from_axis = std::acos(std::abs(ray.y()) / ray.norm());
    EXPECT_GE(from_axis * kDegPerRad, 25.0 - 1e-3);
    range = std::max(range, ray.norm() + 0.1 / std::sin(from_axis));
  }
  EXPECT_NEAR(up, 15.5, 0.5 + 1e-3);
  EXPECT_NEAR(down, 60.5, 0.5 + 1e-3);
  EXPECT_LE(range, 8.0 + 1e-5);
  EXPECT_GT(range, 7.5);
}

TEST(IdealSweep, SeesTheFloorAtZero) {
  const Cloud cloud = Scene().sweep(kDriving);
  const auto floor =
      std::count_if(cloud.points.begin(), cloud.points.end(),
                    [](const Eigen::Vector3f& p) { return std::abs(p.z()) < 0.05F; });
  EXPECT_GT(floor, 500);
}

TEST(IdealSweep, GivesTheSameBitsForASeedWhateverWasScannedBefore) {
  const Scene scene;
  const Cloud alone = scene.sweep(kDriving);
  scene.sweep(3.0);
  const Cloud again = scene.sweep(kDriving);
  EXPECT_EQ(alone.utime_us, 20'000'000);
  EXPECT_EQ(alone.points, again.points);
  EXPECT_EQ(alone.origins, again.origins);
  EXPECT_NE(alone.points, scene.sweep(kDriving, 2).points);
}

}  // namespace
}  // namespace voxlist::simulation
