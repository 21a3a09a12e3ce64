#include "bench/test_floor.h"

#include <cmath>
#include <numbers>

namespace voxlist {
namespace {

constexpr double kRobotRadius_m = 0.35;
constexpr double kRobotHeight_m = 1.0;

bool has_room(const TestFloor& floor, const Pose2& pose) {
  return floor.building.clearance_m({pose.x_m, pose.y_m}, 0.05, kRobotHeight_m) > kRobotRadius_m;
}

Pose2 pose_in(const Eigen::Vector2d& low, const Eigen::Vector2d& high, Random& random) {
  const double x = random.uniform(low.x(), high.x());
  const double y = random.uniform(low.y(), high.y());
  return {x, y, random.uniform(-std::numbers::pi, std::numbers::pi)};
}

}  // namespace

TestFloorConfig floor_60_40(int seed) {
  TestFloorConfig config{"60 x 40 m, seed " + std::to_string(seed), {}, 3, 1.0};
  config.wing.length_m = 60.0;
  config.wing.depth_m = 13.2;
  config.wing.rooms = 20;
  config.wing.seed = 1000 * seed;
  return config;
}

TestFloor make_test_floor(const TestFloorConfig& config) {
  const BuildingConfig& wing = config.wing;
  TestFloor floor{config.name,
                  make_floor(wing, config.wings),
                  {-1.0, -wing.depth_m / 2.0},
                  {wing.length_m - 1.0, (config.wings - 0.5) * wing.depth_m + 0.12 * config.wings},
                  {}};
  Random random(static_cast<std::uint64_t>(wing.seed), 77);
  const double step = config.map_scan_spacing_m;
  std::uint64_t seed = 0;
  for (double y = floor.low.y(); y < floor.high.y(); y += step) {
    for (double x = floor.low.x(); x < floor.high.x(); x += step) {
      const Pose2 pose = pose_in({x, y}, {x + step, y + step}, random);
      if (has_room(floor, pose))
        add_scan(scan_at(floor.building, pose, 0, ++seed), to_pose3(pose), 100.0, floor.map);
    }
  }
  return floor;
}

Pose2 free_pose(const TestFloor& floor, Random& random) {
  for (int i = 0; i < 10'000; ++i) {
    const Pose2 pose = pose_in(floor.low, floor.high, random);
    if (has_room(floor, pose)) return pose;
  }
  return {};
}

Cloud scan_at(const Building& building, const Pose2& pose, int people, std::uint64_t seed) {
  Random random(seed, 5);
  std::vector<Trajectory> standing;
  for (int i = 0; i < people; ++i) {
    const double bearing = random.uniform(-std::numbers::pi, std::numbers::pi);
    const double range = random.uniform(0.8, 3.0);
    standing.emplace_back(
        1.0, std::vector<Pose2>{
                 pose * Pose2{range * std::cos(bearing), range * std::sin(bearing), bearing}});
  }
  const World world(building, standing);
  const Trajectory still(1.0, {pose});
  const MirrorScanner scanner(world, still, {}, seed);
  return scan_sweep(scanner, still, 1.0, {}, seed);
}

}  // namespace voxlist
