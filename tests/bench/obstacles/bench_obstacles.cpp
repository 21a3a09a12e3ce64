// Drives of a robot under the mirror scanner: which drops are NEGATIVE when they are near, what of
// flat floors and ramps is taken for one, which thin things are missed.
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "tests/bench/obstacles/mirror_drive.h"
#include "tests/bench/obstacles/scenes.h"
#include "voxlist/planning/obstacles/obstacle_finder.h"
#include "voxlist/simulation/random.h"

namespace voxlist::bench {
namespace {

using planning::ObstacleFinder;
using planning::ObstacleScan;
using planning::ObstacleType;

// A drop is found where a cell of it is so near to its true edge on the robot's way (m).
constexpr double kAtTheEdge_m = 0.4;

MirrorDriveConfig drive_config(std::uint64_t seed) {
  simulation::Random random(seed, 9);
  MirrorDriveConfig config;
  config.y_m = random.uniform(-0.1, 0.1);
  config.heading_rad = random.uniform(-0.03, 0.03);
  config.seed = seed;
  return config;
}

// Calls see(scan, drive, t) for each slice until it returns false.
template <class See>
void drive_on(const MirrorDrive& drive, double seconds, const See& see) {
  ObstacleFinder finder{planning::ObstacleConfig{}};
  for (int i = 1; i * MirrorDrive::kSlice_s < seconds; ++i) {
    const double t_s = i * MirrorDrive::kSlice_s;
    for (int part = 3; part >= 0; --part) {
      const double at_s = t_s - part * MirrorDrive::kSlice_s / 4.0;
      finder.add_odometry({std::llround(at_s * 1e6), drive.T_odom_base(at_s)});
    }
    if (!see(finder.take(drive.slice(t_s), ObstacleFinder::Part::kSlice), t_s)) return;
  }
}

bool has_drop_near(const ObstacleScan& scan, const Pose3& T_map_base, const Eigen::Vector2d& edge) {
  for (const planning::ObstacleCell& cell : scan.cells) {
    const Eigen::Vector3d place =
        T_map_base * Eigen::Vector3d(cell.centre.x(), cell.centre.y(), 0.0);
    if (cell.type == ObstacleType::kNegative && std::abs(place.x() - edge.x()) < kAtTheEdge_m &&
        std::abs(place.y() - edge.y()) < kAtTheEdge_m)
      return true;
  }
  return false;
}

// How far a drop is when it must be told (m), farthest first.
constexpr std::array kWithin_m{3.0, 2.0, 1.0};

// Whether it is, at each of these.
std::array<bool, kWithin_m.size()> finds_drop(SceneKind kind, std::uint64_t seed, double height_m,
                                              double speed_mps, double sweep_s) {
  const Scene scene = make_scene(kind, seed);
  MirrorDriveConfig config = drive_config(seed);
  config.scanner_height_m = height_m;
  config.speed_mps = speed_mps;
  config.sweep_s = sweep_s;
  const MirrorDrive drive(scene.world, config);
  std::array<bool, kWithin_m.size()> found{};
  std::size_t next = 0;
  drive_on(drive, 60.0, [&](const ObstacleScan& scan, double t_s) {
    const Pose3 truth = drive.truth(t_s);
    if (scene.edge.x() - truth.translation().x() < kWithin_m[next]) ++next;
    if (next == kWithin_m.size()) return false;
    found[next] = has_drop_near(scan, truth, scene.edge);
    return true;
  });
  return found;
}

void tell_drops(std::uint64_t first, std::uint64_t last, double speed_mps, double sweep_s) {
  for (const double height_m : {0.8, 0.4})
    for (const SceneKind kind : kDrops) {
      std::array<int, kWithin_m.size()> found{};
      for (std::uint64_t seed = first; seed <= last; ++seed) {
        const auto drive = finds_drop(kind, seed, height_m, speed_mps, sweep_s);
        for (std::size_t i = 0; i < found.size(); ++i) found[i] += drive[i];
      }
      std::printf("scanner %.1f m up, %.1f m/s, sweep %.0f s: %-6s", height_m, speed_mps, sweep_s,
                  name_of(kind).c_str());
      for (std::size_t i = 0; i < found.size(); ++i)
        std::printf(", %d at %.0f m", found[i], kWithin_m[i]);
      std::printf(" of %d\n", static_cast<int>(last - first + 1));
      std::fflush(stdout);
    }
}

void tell_false_drops(SceneKind kind, std::uint64_t first, std::uint64_t last, double speed_mps) {
  int slices = 0, with_drop = 0, with_obstacle = 0;
  double reach_m = 0.0;
  for (std::uint64_t seed = first; seed <= last; ++seed) {
    const Scene scene = make_scene(kind, seed);
    MirrorDriveConfig config = drive_config(seed);
    config.start_x_m = -4.0;
    config.speed_mps = speed_mps;
    const MirrorDrive drive(scene.world, config);
    drive_on(drive, 8.0 / speed_mps, [&](const ObstacleScan& scan, double t_s) {
      ++slices;
      bool drop = false, obstacle = false;
      for (const planning::ObstacleCell& cell : scan.cells) {
        drop |= cell.type == ObstacleType::kNegative;
        obstacle |= cell.type != ObstacleType::kNegative && std::abs(cell.centre.y()) < 2.5 &&
                    std::abs(cell.centre.x()) < 3.0;
      }
      with_drop += drop;
      with_obstacle += obstacle;
      reach_m += t_s > 3.0 ? static_cast<double>(scan.ground_seen_to_m[0]) : 0.0;
      return true;
    });
  }
  std::printf(
      "%-9s at %.1f m/s: %d slices, %d with a drop, %d with an obstacle within 3 m; ground ahead "
      "%.2f m in the mean\n",
      name_of(kind).c_str(), speed_mps, slices, with_drop, with_obstacle, reach_m / slices);
  std::fflush(stdout);
}

}  // namespace
}  // namespace voxlist::bench

int main(int argc, char** argv) {
  using namespace voxlist::bench;
  const auto first = static_cast<std::uint64_t>(argc > 1 ? std::atoi(argv[1]) : 1),
             last = argc > 2 ? static_cast<std::uint64_t>(std::atoi(argv[2])) : first;
  const std::string only = argc > 3 ? argv[3] : "";
  const double speed = argc > 4 ? std::atof(argv[4]) : 0.5,
               sweep = argc > 5 ? std::atof(argv[5]) : 1.0;
  if (only.empty() || only == "false")
    for (const SceneKind kind : {SceneKind::kFlat, SceneKind::kRampUp, SceneKind::kRampDown})
      tell_false_drops(kind, first, last, speed);
  if (only.empty() || only == "drops") tell_drops(first, last, speed, sweep);
}
