// Scan-by-scan mapping without odometry: each scan is localised in the map of those before it, and
// added to it. How far off the end is after 24 m with turns of up to 24 deg a scan, and how long a
// scan takes. Arguments, each optional: --csv FILE; first seed; number of seeds. CPU time of one
// thread.
#include <tbb/global_control.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <string>
#include <vector>

#include "tests/bench/figures.h"
#include "tests/bench/test_floor.h"
#include "voxlist/mapping/map_builder.h"
#include "voxlist/matching/localisation/localiser.h"

namespace voxlist::bench {
namespace {

constexpr double kStep_m = 0.4, kMostTurn_rad = 24.0 * std::numbers::pi / 180.0;

// Steps towards one goal after another, turning as sharply as allowed: through the first door into
// its room, back, and along the corridor into the next, until `length_m` are driven.
std::vector<Pose2> free_path(const simulation::Building& building, double length_m) {
  std::vector<Eigen::Vector2d> goals;
  for (const simulation::Room& room : building.rooms) {
    const Eigen::Vector2d corridor(room.door.x(), 0.0);
    for (const Eigen::Vector2d& goal : {corridor, room.door, room.centre(), room.door, corridor})
      goals.push_back(goal);
  }
  std::vector<Pose2> path{{0.0, 0.0, 0.0}};
  double driven_m = 0.0;
  for (std::size_t g = 0; g < goals.size() && driven_m < length_m;) {
    Pose2 pose = path.back();
    const Eigen::Vector2d way = goals[g] - Eigen::Vector2d(pose.x_m, pose.y_m);
    if (way.norm() < kStep_m / 2.0) {
      ++g;
      continue;
    }
    const double off_rad = wrap_angle(std::atan2(way.y(), way.x()) - pose.yaw_rad);
    pose.yaw_rad = wrap_angle(pose.yaw_rad + std::clamp(off_rad, -kMostTurn_rad, kMostTurn_rad));
    if (std::abs(off_rad) <= kMostTurn_rad) {
      const double step_m = std::min(kStep_m, way.norm());
      pose = pose * Pose2{step_m, 0.0, 0.0};
      driven_m += step_m;
    }
    path.push_back(pose);
  }
  return path;
}

std::vector<Figure> run(const simulation::BuildingConfig& config, double length_m) {
  const simulation::Building building = simulation::make_building(config);
  const std::vector<Pose2> path = free_path(building, length_m);
  mapping::MapBuilder map;
  matching::Localiser localiser(map.map());
  std::vector<double> match_ms, map_ms;
  int lost = 0;
  double worst_m = 0.0, end_m = 0.0, end_rad = 0.0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    Cloud scan = scan_at(building, path[i], 0, 100 + i);
    scan.utime_us = static_cast<std::int64_t>(i) * 1'000'000;
    double start_ms = cpu_ms();
    const matching::Localisation found = localiser.localise(scan);
    match_ms.push_back(cpu_ms() - start_ms);
    if (!found.tracking()) {
      ++lost;
      continue;
    }
    // The first scan, where the map begins, is at the path's start.
    const Pose2 pose = found.modes.front().T_map_base;
    const Pose2 truth = path.front().inverse() * path[i];
    end_m = distance_m(pose, truth);
    end_rad = turn_rad(pose, truth);
    worst_m = std::max(worst_m, end_m);
    start_ms = cpu_ms();
    if (map.wants(scan, pose)) {
      map.add({to_pose3(pose), scan});
      localiser.map_changed(map.changed_blocks());
    }
    map_ms.push_back(cpu_ms() - start_ms);
  }
  std::vector<double> both;
  for (std::size_t i = 0; i < std::min(match_ms.size(), map_ms.size()); ++i)
    both.push_back(match_ms[i] + map_ms[i]);
  const std::string scene = "wing, seed " + std::to_string(config.seed);
  const auto figure = [&](const char* measure, double value) {
    return Figure{scene, "scan by scan, no odometry", measure, value};
  };
  const std::vector<Figure> figures{figure("scans", static_cast<double>(path.size())),
                                    figure("lost", lost),
                                    figure("end_off_m", end_m),
                                    figure("end_off_deg", end_rad * 180.0 / std::numbers::pi),
                                    figure("worst_off_m", worst_m),
                                    figure("matching_cpu_median_ms", percentile(match_ms, 0.5)),
                                    figure("mapping_cpu_median_ms", percentile(map_ms, 0.5)),
                                    figure("both_cpu_median_ms", percentile(both, 0.5)),
                                    figure("both_cpu_p95_ms", percentile(both, 0.95))};
  print(scene, figures);
  return figures;
}

}  // namespace
}  // namespace voxlist::bench

int main(int argc, char** argv) {
  using namespace voxlist::bench;
  const auto csv = take_csv_option(argc, argv);
  // What ctest passes to all benchmarks: one small run.
  const bool brief = argc > 1 && std::string(argv[1]).starts_with("--");
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const int first = !brief && argc > 1 ? std::atoi(argv[1]) : 1;
  const int seeds = brief ? 1 : argc > 2 ? std::atoi(argv[2]) : 5;
  std::vector<Figure> figures;
  for (int seed = first; seed < first + seeds; ++seed) {
    voxlist::simulation::BuildingConfig config;
    config.seed = seed;
    const auto measured = run(config, brief ? 3.0 : 24.0);
    figures.insert(figures.end(), measured.begin(), measured.end());
  }
  if (csv) append_csv(*csv, "bench_odometry", figures);
}
