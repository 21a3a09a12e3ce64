// Scan-by-scan mapping without odometry: each scan is localised in the map of those before it, and
// added to it. How far off the end is after 24 m with turns of up to 24 deg a scan, and how long a
// scan takes. Arguments: first seed, number of seeds. CPU time of one thread.
#include <tbb/global_control.h>
#include <time.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <numbers>

#include "bench/test_floor.h"
#include "mapping/map_builder.h"
#include "matching/localiser.h"

namespace voxlist {
namespace {

constexpr double kStep_m = 0.4, kMostTurn_rad = 24.0 * std::numbers::pi / 180.0;

double cpu_ms() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) * 1e3 + static_cast<double>(t.tv_nsec) * 1e-6;
}

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

// Steps towards one goal after another, turning as sharply as allowed: through the first door into
// its room, back, and along the corridor into the next, until `length_m` are driven.
std::vector<Pose2> free_path(const Building& building, double length_m) {
  std::vector<Eigen::Vector2d> goals;
  for (const Room& room : building.rooms) {
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

void run(const BuildingConfig& config, double length_m) {
  const Building building = make_building(config);
  const std::vector<Pose2> path = free_path(building, length_m);
  MapBuilder map;
  Localiser localiser(map.map());
  std::vector<double> match_ms, map_ms;
  int lost = 0;
  double worst_m = 0.0, end_m = 0.0, end_rad = 0.0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    Cloud scan = scan_at(building, path[i], 0, 100 + i);
    scan.utime_us = static_cast<std::int64_t>(i) * 1'000'000;
    double start_ms = cpu_ms();
    const Localisation found = localiser.localise(scan);
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
    if (map.wants(pose)) {
      map.add({to_pose3(pose), scan});
      localiser.map_changed();
    }
    map_ms.push_back(cpu_ms() - start_ms);
  }
  std::vector<double> both;
  for (std::size_t i = 0; i < std::min(match_ms.size(), map_ms.size()); ++i)
    both.push_back(match_ms[i] + map_ms[i]);
  std::printf(
      "seed %d: %zu scans, lost %d, end off %.3f m %.2f deg, worst %.3f m; CPU ms a scan: matching "
      "%.1f, mapping %.1f, both %.1f, p95 %.1f\n",
      config.seed, path.size(), lost, end_m, end_rad * 180.0 / std::numbers::pi, worst_m,
      percentile(match_ms, 0.5), percentile(map_ms, 0.5), percentile(both, 0.5),
      percentile(both, 0.95));
  std::fflush(stdout);
}

}  // namespace
}  // namespace voxlist

int main(int argc, char** argv) {
  using namespace voxlist;
  // What ctest passes to all benchmarks: one small run.
  const bool brief = argc > 1 && std::strncmp(argv[1], "--", 2) == 0;
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const int first = !brief && argc > 1 ? std::atoi(argv[1]) : 1;
  const int seeds = !brief && argc > 2 ? std::atoi(argv[2]) : brief ? 1 : 5;
  for (int seed = first; seed < first + seeds; ++seed) {
    BuildingConfig config;
    config.seed = seed;
    run(config, brief ? 3.0 : 24.0);
  }
}
