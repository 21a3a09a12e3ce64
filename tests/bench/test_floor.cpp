#include "tests/bench/test_floor.h"

#include <tbb/parallel_pipeline.h>

#include <cmath>
#include <numbers>

#include "voxlist/simulation/building/floor_plan.h"

namespace voxlist::bench {
namespace {

constexpr double kRobotRadius_m = 0.35;
constexpr double kRobotHeight_m = 1.0;
constexpr double kReach_m = 100.0;
constexpr std::size_t kScansUnderWay = 16;  // bounds memory

bool has_room(const simulation::Building& building, const Pose2& pose) {
  return building.clearance_m({pose.x_m, pose.y_m}, 0.05, kRobotHeight_m) > kRobotRadius_m;
}

Pose2 pose_in(const Eigen::Vector2d& low, const Eigen::Vector2d& high, simulation::Random& random) {
  const double x = random.uniform(low.x(), high.x());
  const double y = random.uniform(low.y(), high.y());
  return {x, y, random.uniform(-std::numbers::pi, std::numbers::pi)};
}

std::vector<simulation::Trajectory> people_round(const Pose2& pose, int people,
                                                 simulation::Random& random) {
  std::vector<simulation::Trajectory> standing;
  for (int i = 0; i < people; ++i) {
    const double bearing = random.uniform(-std::numbers::pi, std::numbers::pi);
    const double range = random.uniform(0.8, 3.0);
    standing.emplace_back(
        1.0, std::vector<Pose2>{
                 pose * Pose2{range * std::cos(bearing), range * std::sin(bearing), bearing}});
  }
  return standing;
}

simulation::World world_round(const simulation::Building& building, const Pose2& pose, int people,
                              std::uint64_t seed) {
  simulation::Random random(seed, 5);
  return simulation::World(building, people_round(pose, people, random));
}

Cloud scan_in(const simulation::World& world, const Pose2& pose, std::uint64_t seed) {
  const simulation::Trajectory still(1.0, {pose});
  const simulation::MirrorScanner scanner(world, still, {}, seed);
  return simulation::scan_sweep(scanner, still, 1.0, {}, seed);
}

TestFloorConfig floor_of(const std::string& name, int seed, double length_m, double depth_m,
                         int rooms, int wings) {
  TestFloorConfig config{name + ", seed " + std::to_string(seed), {}, wings, 1.0, false};
  config.wing.length_m = length_m;
  config.wing.depth_m = depth_m;
  config.wing.rooms = rooms;
  config.wing.seed = 1000 * seed;
  return config;
}

// One in each square that has room for the robot, row by row.
std::vector<Pose2> map_poses(const TestFloor& floor) {
  simulation::Random random(static_cast<std::uint64_t>(floor.config.wing.seed), 77);
  const double step = floor.config.map_scan_spacing_m;
  std::vector<Pose2> poses;
  for (double y = floor.low.y(); y < floor.high.y(); y += step) {
    for (double x = floor.low.x(); x < floor.high.x(); x += step) {
      const Pose2 pose = pose_in({x, y}, {x + step, y + step}, random);
      if (has_room(floor.building, pose)) poses.push_back(pose);
    }
  }
  return poses;
}

// Where the map believes that its scans were taken.
std::vector<Pose2> believed(std::vector<Pose2> poses, const TestFloorConfig& config) {
  simulation::Random random(static_cast<std::uint64_t>(config.wing.seed), 78);
  for (Pose2& pose : poses) {
    pose.x_m += config.misplaced_m * random.normal();
    pose.y_m += config.misplaced_m * random.normal();
    pose.yaw_rad += config.misplaced_rad * random.normal();
  }
  return poses;
}

// All threads scan; one adds the scans, in the order of the poses.
void fill_map(TestFloor& floor) {
  const simulation::World world(floor.building);
  const std::vector<Pose2> poses = map_poses(floor), places = believed(poses, floor.config);
  const auto scan = [&](std::size_t i) {
    return floor.config.map_of_spheres ? scan_sphere(world, poses[i], {}, i + 1)
                                       : scan_in(world, poses[i], i + 1);
  };
  std::size_t asked = 0, added = 0;
  tbb::parallel_pipeline(
      kScansUnderWay,
      tbb::make_filter<void, std::size_t>(tbb::filter_mode::serial_in_order,
                                          [&](tbb::flow_control& flow) {
                                            if (asked == poses.size()) flow.stop();
                                            return asked++;
                                          }) &
          tbb::make_filter<std::size_t, Cloud>(tbb::filter_mode::parallel, scan) &
          tbb::make_filter<Cloud, void>(tbb::filter_mode::serial_in_order, [&](const Cloud& cloud) {
            add_scan(cloud, to_pose3(places[added++]), kReach_m, floor.map);
          }));
}

}  // namespace

TestFloorConfig floor_60_40(int seed) { return floor_of("60 x 40 m", seed, 60.0, 13.2, 20, 3); }

TestFloorConfig floor_16_13(int seed) { return floor_of("16 x 13 m", seed, 16.0, 13.2, 4, 1); }

TestFloorConfig few_scans_floor(int seed) {
  TestFloorConfig config = floor_16_13(seed);
  config.map_scan_spacing_m = 2.5;
  return config;
}

TestFloorConfig floor_200_150(int seed) {
  return floor_of("200 x 150 m", seed, 200.0, 13.5, 66, 11);
}

TestFloorConfig floor_40_25(int seed) {
  TestFloorConfig config = floor_of("40 x 25 m", seed, 40.0, 12.4, 16, 2);
  config.map_scan_spacing_m = 2.0;
  config.map_of_spheres = true;
  return config;
}

TestFloorConfig identical_floor(int seed) {
  TestFloorConfig config = floor_of("identical rooms", seed, 40.0, 13.0, 16, 2);
  config.wing.alike = config.wing.seed;
  return config;
}

TestFloorConfig hotel_floor(int seed) {
  TestFloorConfig config = identical_floor(seed);
  config.name = "hotel, seed " + std::to_string(seed);
  config.wing.objects = 2;
  return config;
}

TestFloorConfig misplaced(TestFloorConfig config) {
  config.name += ", scans misplaced";
  config.misplaced_m = 0.005;
  config.misplaced_rad = 0.001;
  return config;
}

TestFloor make_test_floor(const TestFloorConfig& config) {
  const simulation::BuildingConfig& wing = config.wing;
  TestFloor floor{config.name,
                  config,
                  make_floor(wing, config.wings),
                  {-1.0, -wing.depth_m / 2.0},
                  {wing.length_m - 1.0,
                   (config.wings - 0.5) * wing.depth_m + simulation::kWall_m * config.wings},
                  {}};
  fill_map(floor);
  return floor;
}

simulation::Building later(TestFloorConfig config) {
  config.wing.changed = 7;
  return make_floor(config.wing, config.wings);
}

TestFloorConfig elsewhere(TestFloorConfig config) {
  config.wing.seed += 500;
  if (config.wing.alike != 0) config.wing.alike += 500;
  return config;
}

Pose2 free_pose(const TestFloor& floor, simulation::Random& random) {
  for (int i = 0; i < 10'000; ++i) {
    const Pose2 pose = pose_in(floor.low, floor.high, random);
    if (has_room(floor.building, pose)) return pose;
  }
  return {};
}

Cloud scan_at(const simulation::Building& building, const Pose2& pose, int people,
              std::uint64_t seed) {
  return scan_in(world_round(building, pose, people, seed), pose, seed);
}

Cloud sphere_scan_at(const simulation::Building& building, const Pose2& pose, int points,
                     int people, std::uint64_t seed) {
  simulation::SphereScanConfig config;
  config.rays = points;
  return scan_sphere(world_round(building, pose, people, seed), pose, config, seed);
}

}  // namespace voxlist::bench
