#include "bench/world.h"

#include <cmath>
#include <numbers>

namespace voxlist {
namespace {

constexpr double kRobotRadius_m = 0.35;
constexpr double kRobotHeight_m = 1.0;

bool has_room(const TestFloor& world, const Pose2& pose) {
  return world.building.clearance_m({pose.x_m, pose.y_m}, 0.05, kRobotHeight_m) > kRobotRadius_m;
}

Pose2 pose_in(const Eigen::Vector2d& low, const Eigen::Vector2d& high, Random& random) {
  const double x = random.uniform(low.x(), high.x());
  const double y = random.uniform(low.y(), high.y());
  return {x, y, random.uniform(-std::numbers::pi, std::numbers::pi)};
}

void add_scan(const Cloud& scan, const Pose2& pose, TestFloor& world) {
  VoxelMap& map = world.map;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const Eigen::Vector3d p_map = pose * scan.points[i].cast<double>();
    map.insert(voxel_at(p_map, map.resolution_m()));
    const Eigen::Vector3d from = pose * scan.origin(i).cast<double>();
    const double length = (p_map - from).norm();
    for (double t = 0.0; t < length - 0.1; t += 0.15) world.free.insert(voxel_at(Eigen::Vector3d(from + (p_map - from) * (t / length)), 0.16));
  }
}

}  // namespace

WorldConfig floor_60_40(int seed) {
  WorldConfig config{"60 x 40 m, seed " + std::to_string(seed), {}, 3, 1.0};
  config.wing.length_m = 60.0;
  config.wing.depth_m = 13.2;
  config.wing.rooms = 20;
  config.wing.seed = 1000 * seed;
  return config;
}

WorldConfig floor_200_150(int seed) {
  WorldConfig config{"200 x 150 m, seed " + std::to_string(seed), {}, 10, 1.0};
  config.wing.length_m = 200.0;
  config.wing.depth_m = 14.9;
  config.wing.rooms = 60;
  config.wing.seed = 1000 * seed;
  return config;
}

TestFloor make_test_floor(const WorldConfig& config) {
  const BuildingConfig& wing = config.wing;
  TestFloor world{config.name,
              make_floor(wing, config.wings),
              {-1.0, -wing.depth_m / 2.0},
              {wing.length_m - 1.0, (config.wings - 0.5) * wing.depth_m + 0.12 * config.wings},
              VoxelMap(kFinestResolution_m), VoxelMap(0.16)};
  Random random(static_cast<std::uint64_t>(wing.seed), 77);
  const double step = config.map_scan_spacing_m;
  std::uint64_t seed = 0;
  for (double y = world.low.y(); y < world.high.y(); y += step) {
    for (double x = world.low.x(); x < world.high.x(); x += step) {
      const Pose2 pose = pose_in({x, y}, {x + step, y + step}, random);
      if (has_room(world, pose)) add_scan(scan_at(world.building, pose, 0, ++seed), pose, world);
    }
  }
  return world;
}

Pose2 free_pose(const TestFloor& world, Random& random) {
  for (int i = 0; i < 10'000; ++i) {
    const Pose2 pose = pose_in(world.low, world.high, random);
    if (has_room(world, pose)) return pose;
  }
  return {};
}

Cloud scan_at(const Building& building, const Pose2& pose, int people, std::uint64_t seed) {
  Random random(seed, 5);
  std::vector<Trajectory> standing;
  for (int i = 0; i < people; ++i) {
    const double bearing = random.uniform(-std::numbers::pi, std::numbers::pi);
    const double range = random.uniform(0.8, 3.0);
    standing.emplace_back(1.0, std::vector<Pose2>{pose * Pose2{range * std::cos(bearing), range * std::sin(bearing), bearing}});
  }
  const World world(building, standing);
  const Trajectory still(1.0, {pose});
  const MirrorScanner scanner(world, still, {}, seed);
  return scan_sweep(scanner, still, 1.0, {}, seed);
}

}  // namespace voxlist
