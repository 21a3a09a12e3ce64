// Global localisation of single scans in simulated floors: how often right, how exact, how long.
#include <tbb/global_control.h>
#include <time.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "bench/world.h"
#include "matching/global_search.h"
#include "matching/refine.h"

namespace voxlist {
namespace {

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

std::vector<Eigen::Vector3f> chosen(const TolerantMap& map, const Cloud& scan, std::size_t most) {
  std::vector<Eigen::Vector3f> points;
  for (const auto& p : scan.points) {
    const auto z = static_cast<std::int32_t>(std::floor(double(p.z()) / map.cell_height_m())) - map.lowest().z;
    if (map.fill(z) < 0.3) points.push_back(p);
  }
  std::vector<Eigen::Vector3f> out;
  const std::size_t n = std::min(most, points.size());
  // golden stride
  for (std::size_t i = 0; i < n; ++i) {
    const double f = std::fmod(static_cast<double>(i) * 0.61803398875, 1.0);
    out.push_back(points[static_cast<std::size_t>(f * static_cast<double>(points.size()))]);
  }
  return out;
}

void run(const WorldConfig& config, int queries, std::size_t most, double ratio) {
  const double t0 = cpu_ms();
  const World world = make_world(config);
  const double t1 = cpu_ms();
  const TolerantMap map(world.map, {});
  const double t2 = cpu_ms();
  const CoarseMap coarse(map, 9.0);
  const double t3 = cpu_ms();
  const SurfelMap surfels(world.map);
  std::printf("%s: %zu voxels, world %.1f s, preparation %.0f + %.0f + %.0f ms, %d x %d x %d\n", world.name.c_str(),
              world.map.size(), (t1 - t0) * 1e-3, t2 - t1, t3 - t2, cpu_ms() - t3, map.size_x(), map.size_y(), map.size_z());
  Random random(4711, static_cast<std::uint64_t>(config.wing.seed));
  std::vector<double> times, errors, turns, e0, sw, lf, ce, leaves;
  int right = 0, right0 = 0, certified = 0;
  for (int q = 0; q < queries; ++q) {
    const Pose2 truth = free_pose(world, random);
    const Cloud scan = scan_at(world.building, truth, 1'000'000 + static_cast<std::uint64_t>(q));
    const double start = cpu_ms();
    const auto points = chosen(map, scan, most);
    GlobalSearchConfig gc;
    gc.mode_ratio = ratio;
    gc.max_modes = static_cast<std::size_t>(std::atoi(std::getenv("K") ? std::getenv("K") : "3"));
    const GlobalSearchResult match = global_search(map, coarse, points, gc);
    double best_fit = -1;
    Pose2 best;
    for (const auto& m : match.modes) {
      const Refinement r = refine(surfels, points, {m.pose.x_m + 0.02, m.pose.y_m + 0.02, m.pose.yaw_rad});
      if (r.inlier_share > best_fit) best_fit = r.inlier_share, best = r.pose;
    }
    times.push_back(cpu_ms() - start);
    ce.push_back(match.ms_cells), sw.push_back(match.ms_sweep), lf.push_back(match.ms_leaves), leaves.push_back(double(match.leaves));
    certified += match.certified && match.complete;
    if (match.modes.empty()) continue;
    const double error = distance_m(best, truth), turn = turn_rad(best, truth);
    right0 += distance_m(match.modes[0].pose, truth) < 0.08;
    if (error < 0.05 && turn < 0.5 / 57.3) ++right, errors.push_back(error), turns.push_back(turn);
    else std::printf("  wrong: %.2f %.2f %.2f: %zu points, off %.2f m, fit %.3f overlap %d second %d of %zu\n", truth.x_m, truth.y_m, truth.yaw_rad, scan.points.size(), error, best_fit, match.modes[0].overlap, match.modes.size() > 1 ? match.modes[1].overlap : 0, points.size());
  }
  std::printf("  right %d (before %d) of %d, certified %d, error median %.1f mm %.3f deg, CPU ms median %.1f p95 %.1f max %.1f; cells %.1f sweep %.1f leaves %.1f (max %.1f), leaves %.0f p95 %.0f\n",
              right, right0, queries, certified, 1e3 * percentile(errors, 0.5), 57.3 * percentile(turns, 0.5),
              percentile(times, 0.5), percentile(times, 0.95), percentile(times, 1.0), percentile(ce, .5), percentile(sw, .5), percentile(lf, .5), percentile(lf, 1.), percentile(leaves, .5), percentile(leaves, .95));
}

}  // namespace
}  // namespace voxlist

int main(int argc, char** argv) {
  using namespace voxlist;
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const int queries = argc > 1 ? std::atoi(argv[1]) : 50;
  const std::size_t most = argc > 2 ? static_cast<std::size_t>(std::atoi(argv[2])) : 1500;
  const double ratio = argc > 3 ? std::atof(argv[3]) : 0.9;
  const int large = argc > 4 ? std::atoi(argv[4]) : 0;
  run(floor_60_40(1), queries, most, ratio);
  if (large > 0) run(floor_200_150(1), large, most, ratio);
}
