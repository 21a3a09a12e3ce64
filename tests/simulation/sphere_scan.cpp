#include "tests/simulation/sphere_scan.h"

#include <cmath>
#include <numbers>

#include "voxlist/simulation/random.h"

namespace voxlist::simulation {
namespace {

// Even heights on the sphere, turned by the golden angle from one to the next.
Eigen::Vector3d ray(int i, int rays) {
  constexpr double kGoldenAngle = 2.0 * std::numbers::pi * (2.0 - std::numbers::phi);
  const double z = 1.0 - (2.0 * i + 1.0) / rays;
  const double radius = std::sqrt(1.0 - z * z), angle = kGoldenAngle * i;
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

}  // namespace

Cloud scan_sphere(const World& world, const Pose2& T_map_base, const SphereScanConfig& config,
                  std::uint64_t seed) {
  Random random(seed);
  const Pose2 turn{0.0, 0.0, T_map_base.yaw_rad};
  const Eigen::Vector3d eye_base(0.0, 0.0, config.height_m), eye_map = T_map_base * eye_base;
  Cloud cloud;
  for (int i = 0; i < config.rays; ++i) {
    const Eigen::Vector3d direction = ray(i, config.rays);
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
