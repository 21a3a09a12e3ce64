#include "tests/simulation/sphere_scan.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "voxlist/geometry/angle.h"
#include "voxlist/simulation/random.h"

namespace voxlist::simulation {
namespace {

// Even heights on the sphere, turned by the golden angle from one to the next.
Eigen::Vector3d even_ray(int i, int rays) {
  constexpr double kGoldenAngle = 2.0 * std::numbers::pi * (2.0 - std::numbers::phi);
  const double z = 1.0 - (2.0 * i + 1.0) / rays;
  const double radius = std::sqrt(1.0 - z * z), angle = kGoldenAngle * i;
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

Eigen::Vector3d ring_ray(int i, const SphereScanConfig& config) {
  const int columns = config.rays / config.rings;
  const double up = config.rings_to_deg * kRadPerDeg *
                    (2.0 * (i / columns) / std::max(1, config.rings - 1) - 1.0);
  const double angle = 2.0 * std::numbers::pi * (i % columns) / columns;
  return {std::cos(up) * std::cos(angle), std::cos(up) * std::sin(angle), std::sin(up)};
}

Eigen::Vector3d ray(int i, const SphereScanConfig& config) {
  return config.rings > 0 ? ring_ray(i, config) : even_ray(i, config.rays);
}

}  // namespace

Cloud scan_sphere(const World& world, const Pose2& T_map_base, const SphereScanConfig& config,
                  std::uint64_t seed) {
  Random random(seed);
  const Pose2 turn{0.0, 0.0, T_map_base.yaw_rad};
  const Eigen::Vector3d eye_base(0.0, 0.0, config.height_m), eye_map = T_map_base * eye_base;
  Cloud cloud;
  for (int i = 0; i < config.rays; ++i) {
    const Eigen::Vector3d direction = ray(i, config);
    const auto hit = world.range(eye_map, turn * direction, 0.0);
    if (!hit) continue;
    const double range = *hit + config.range_sd_m * random.normal();
    if (range < config.range_min_m || range > config.range_max_m) continue;
    cloud.points.push_back((eye_base + range * direction).cast<float>());
  }
  cloud.origins.assign(cloud.points.size(), eye_base.cast<float>());
  return cloud;
}

}  // namespace voxlist::simulation
