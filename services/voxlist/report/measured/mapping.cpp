#include "services/voxlist/report/measured/mapping.h"

#include <cmath>
#include <numbers>

#include "voxlist/geometry/elementary.h"
#include "voxlist/matching/localisation/localiser.h"
#include "voxlist/simulation/random.h"

namespace voxlist::desk {
namespace {

constexpr double kReach_m = 100.0;
constexpr double kRadians = std::numbers::pi / 180.0;

}  // namespace

std::vector<Pose2> odometry_of(const std::vector<PlacedScan>& tour, int seed) {
  simulation::Random random(static_cast<std::uint64_t>(seed), 20);
  std::vector<Pose2> odometry{tour.front().truth};
  for (std::size_t i = 1; i < tour.size(); ++i) {
    const Pose2 motion = tour[i - 1].truth.inverse() * tour[i].truth;
    const double x = 0.05 * random.normal(), y = 0.05 * random.normal();
    const double yaw = 1.0 * kRadians * random.normal();
    odometry.push_back(odometry.back() *
                       Pose2{motion.x_m + x, motion.y_m + y, motion.yaw_rad + yaw});
  }
  return odometry;
}

MatchedMap map_by_filter(const std::vector<PlacedScan>& tour, int final_factor, int seed) {
  const std::vector<Pose2> odometry = odometry_of(tour, seed);
  MatchedMap made;
  for (std::size_t i = 0; i < tour.size(); ++i) {
    Pose2 pose = tour[i].truth;
    if (i > 0) {
      pose = made.poses.back() * (odometry[i - 1].inverse() * odometry[i]);
      const matching::ParticleFilter filter(made.map.occupied, {.final_factor = final_factor});
      const auto found =
          filter.localise(tour[i].cloud.points, {pose, 0.3, 0.3, 9.0 * kRadians}).particles;
      if (!found.empty()) pose = found.front().pose;
      made.errors_m.push_back(distance_m(pose, tour[i].truth));
    }
    made.poses.push_back(pose);
    add_scan(tour[i].cloud, to_pose3(pose), kReach_m, made.map);
  }
  return made;
}

MatchedMap map_by_localiser(const std::vector<PlacedScan>& tour, int seed) {
  const std::vector<Pose2> odometry = odometry_of(tour, seed);
  OccupancyMap map;
  matching::LocaliserConfig config;
  config.threads = 1;
  matching::Localiser localiser(map, config);
  MatchedMap made;
  for (std::size_t i = 0; i < tour.size(); ++i) {
    const auto found = localiser.localise(tour[i].cloud, odometry[i]);
    if (!found.tracking()) continue;
    const Pose2 pose = tour.front().truth * found.modes.front().T_map_base;
    made.poses.push_back(pose);
    if (i > 0) made.errors_m.push_back(distance_m(pose, tour[i].truth));
    add_scan(tour[i].cloud, to_pose3(found.modes.front().T_map_base), kReach_m, map);
    add_scan(tour[i].cloud, to_pose3(pose), kReach_m, made.map);
  }
  return made;
}

Cloud flexed(Cloud scan) {
  constexpr double kFlex_rad = 0.33 * kRadians, kAxis_m = 0.6;
  for (Eigen::Vector3f& point : scan.points) {
    const double x = point.x(), z = point.z() - kAxis_m;
    const double phi = elementary::atan2(-x, z);  // 0: straight up; the mirror turns by half of it
    const double turned = phi + 2.0 * kFlex_rad * elementary::sin(phi / 2.0),
                 range = elementary::hypot(x, z);
    point.x() = static_cast<float>(-range * elementary::sin(turned));
    point.z() = static_cast<float>(range * elementary::cos(turned) + kAxis_m);
  }
  return scan;
}

}  // namespace voxlist::desk
