#include "tests/simulation/sphere_scan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace voxlist::simulation {
namespace {

// A bare box of 16 x 2.2 x 2.6 m; the origin is 1 m from its end.
World corridor() {
  BuildingConfig config;
  config.rooms = 0;
  config.furniture_per_room = 0;
  return World(make_building(config));
}

TEST(SphereScan, SeesFloorCeilingAndAllWallsWhereTheyAre) {
  const World world = corridor();
  const Pose2 pose{3.0, 0.2, 0.7};
  const Cloud cloud = scan_sphere(world, pose, {}, 1);
  ASSERT_EQ(cloud.points.size(), 64'000u);
  ASSERT_EQ(cloud.origins.size(), cloud.points.size());
  double sum = 0.0;
  int floor = 0, ceiling = 0, walls = 0;
  for (const auto& p : cloud.points) {
    const Eigen::Vector3d at = pose * p.cast<double>();
    const double off[] = {at.z(),        2.6 - at.z(), at.x() + 1.0,
                          15.0 - at.x(), at.y() + 1.1, 1.1 - at.y()};
    const double nearest =
        std::abs(*std::min_element(std::begin(off), std::end(off),
                                   [](double a, double b) { return std::abs(a) < std::abs(b); }));
    EXPECT_LT(nearest, 6.0 * 0.015 + 1e-5);
    sum += nearest * nearest;
    (std::abs(off[0]) < 0.09 ? floor : std::abs(off[1]) < 0.09 ? ceiling : walls) += 1;
  }
  EXPECT_LT(std::sqrt(sum / 64'000.0), 0.015);
  EXPECT_GT(std::sqrt(sum / 64'000.0), 0.005);
  EXPECT_GT(floor, 10'000);
  EXPECT_GT(ceiling, 5'000);
  EXPECT_GT(walls, 20'000);
}

TEST(SphereScan, SpreadsItsRaysEvenly) {
  SphereScanConfig config;
  config.range_sd_m = 0.0;
  const Cloud cloud = scan_sphere(corridor(), {}, config, 1);
  int octants[8] = {};
  double nearest = 10.0;
  const Eigen::Vector3f eye = cloud.origin(0);
  EXPECT_EQ(eye, Eigen::Vector3f(0.0f, 0.0f, 1.0f));
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const Eigen::Vector3f ray = (cloud.points[i] - eye).normalized();
    ++octants[(ray.x() > 0.0f) + 2 * (ray.y() > 0.0f) + 4 * (ray.z() > 0.0f)];
    if (i != 30'000)
      nearest = std::min(nearest, double{(ray - (cloud.points[30'000] - eye).normalized()).norm()});
  }
  for (const int count : octants) EXPECT_NEAR(count, 8000, 40);
  EXPECT_GT(nearest, 0.7 * std::sqrt(4.0 * 3.14159 / 64'000.0));  // nobody's neighbour is too near
}

TEST(SphereScan, EndsAtItsRangeAndDependsOnItsSeedAlone) {
  const World world = corridor();
  SphereScanConfig config;
  config.range_max_m = 5.0;
  config.rays = 1000;
  const Cloud cloud = scan_sphere(world, {}, config, 1);
  EXPECT_LT(cloud.points.size(), 1000u);
  for (std::size_t i = 0; i < cloud.points.size(); ++i)
    EXPECT_LE((cloud.points[i] - cloud.origin(i)).norm(), 5.00001f);
  EXPECT_EQ(cloud.points, scan_sphere(world, {}, config, 1).points);
  EXPECT_NE(cloud.points, scan_sphere(world, {}, config, 2).points);
}

TEST(SphereScan, LaysItsRaysInRingsWhereItIsTold) {
  SphereScanConfig config{.rays = 16 * 360, .rings = 16};
  config.range_sd_m = 0.0;
  std::map<int, int> rays_at;  // 0.1 deg of elevation
  const Cloud cloud = scan_sphere(corridor(), {}, config, 1);
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const Eigen::Vector3f ray = cloud.points[i] - cloud.origin(i);
    ++rays_at[static_cast<int>(std::lround(1800.0 / 3.14159 * std::asin(ray.normalized().z())))];
  }
  ASSERT_EQ(rays_at.size(), 16u);
  for (int ring = 0; ring < 16; ++ring) EXPECT_EQ(rays_at[-150 + 20 * ring], 360) << ring;
}

}  // namespace
}  // namespace voxlist::simulation
