#include "services/voxlist/report/measured/scene.h"

#include <cmath>
#include <numbers>

#include "voxlist/geometry/elementary.h"
#include "voxlist/simulation/random.h"
#include "voxlist/simulation/run/simulated_run.h"
#include "voxlist/simulation/scanner/ideal_sweep.h"

namespace voxlist::desk {
namespace {

constexpr std::size_t kMapScans = 20;  // paper, section III: "built by combining 20 scans"
constexpr double kRobotRadius_m = 0.35, kRobotHeight_m = 1.0;
constexpr double kReach_m = 100.0;

simulation::BuildingConfig config_of(int seed, Floor floor, bool changed) {
  simulation::BuildingConfig config;
  config.length_m = floor == Floor::kRooms ? 10.0 : 16.0;
  config.depth_m = floor == Floor::kRooms ? 9.0 : 12.0;
  config.rooms = floor == Floor::kRooms ? 4 : 6;
  config.seed = seed;
  config.changed = changed ? 7 : 0;
  return config;
}

std::vector<PlacedScan> tour_of(int seed, Floor floor) {
  simulation::SimulationConfig config;
  config.seed = seed;
  config.building = config_of(seed, floor, false);
  config.perfect_deskew = true;
  simulation::SimulatedRun run(config);
  std::vector<PlacedScan> all;
  while (auto event = run.next())
    if (auto* cloud = std::get_if<Cloud>(&*event)) {
      const Pose2 truth = run.truth().at(static_cast<double>(cloud->utime_us) * 1e-6);
      all.push_back({std::move(*cloud), truth});
    }
  std::vector<PlacedScan> chosen;
  for (std::size_t i = 0; i < kMapScans; ++i)
    chosen.push_back(std::move(all[i * (all.size() - 1) / (kMapScans - 1)]));
  return chosen;
}

std::vector<simulation::Trajectory> people_about(const Pose2& pose, int people,
                                                 std::uint64_t seed) {
  simulation::Random random(seed, 5);
  std::vector<simulation::Trajectory> standing;
  for (int i = 0; i < people; ++i) {
    const double bearing = random.uniform(-std::numbers::pi, std::numbers::pi);
    const double range = random.uniform(0.8, 3.0);
    standing.emplace_back(
        1.0, std::vector<Pose2>{pose * Pose2{range * elementary::cos(bearing),
                                             range * elementary::sin(bearing), bearing}});
  }
  return standing;
}

}  // namespace

ReportScale quick_scale() { return {3, 200, 4, 1, 5}; }

Scene::Scene(int seed, const ReportScale& scale, Floor floor)
    : seed_(seed),
      floor_(floor),
      scale_(scale),
      world_(building_of(seed, floor)),
      tour_(tour_of(seed, floor)) {
  for (const PlacedScan& scan : tour_) add_scan(scan.cloud, to_pose3(scan.truth), kReach_m, map_);
}

std::vector<PlacedScan> Scene::queries(int count) const {
  std::vector<PlacedScan> scans;
  for (int i = 0; i < count; ++i) {
    const auto number = static_cast<std::uint64_t>(i);
    const Pose2 truth =
        free_pose(world_.building(), floor_, static_cast<std::uint64_t>(seed_), number);
    scans.push_back({standing_scan(world_.building(), truth, 0, 1000 + number), truth});
  }
  return scans;
}

matching::PoseWindow Scene::everywhere() const { return matching::whole_map(map_.occupied); }

simulation::Building building_of(int seed, Floor floor, bool changed) {
  return simulation::make_building(config_of(seed, floor, changed));
}

Pose2 free_pose(const simulation::Building& building, Floor floor, std::uint64_t seed,
                std::uint64_t number) {
  const simulation::BuildingConfig size = config_of(0, floor, false);
  simulation::Random random(4711 + seed, number);
  for (int i = 0; i < 10'000; ++i) {
    const double x = random.uniform(-1.0, size.length_m - 1.0);
    const double y = random.uniform(-size.depth_m / 2.0, size.depth_m / 2.0);
    const double yaw = random.uniform(-std::numbers::pi, std::numbers::pi);
    if (building.clearance_m({x, y}, 0.05, kRobotHeight_m) > kRobotRadius_m) return {x, y, yaw};
  }
  return {};
}

Cloud standing_scan(const simulation::Building& building, const Pose2& pose, int people,
                    std::uint64_t seed) {
  const simulation::World world(building, people_about(pose, people, seed));
  const simulation::Trajectory still(1.0, {pose});
  const simulation::MirrorScanner scanner(world, still, {}, seed);
  return simulation::scan_sweep(scanner, still, 1.0, {}, seed);
}

}  // namespace voxlist::desk
