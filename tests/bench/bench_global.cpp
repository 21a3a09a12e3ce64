// Global localisation of single scans in simulated floors: how often right, how exact, how long.
#include <tbb/global_control.h>
#include <time.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "bench/world.h"
#include "matching/global_search.h"
#include "matching/refine.h"
#include "io/scan_folder.h"

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

// Share of rays that pass through an occupied voxel of 0.08 m, well before they end; and share of points on occupied.
double violations(const VoxelMap& map8, const Cloud& scan, const Pose2& pose) {
  int through = 0, rays = 0;
  for (std::size_t i = 0; i < scan.points.size(); i += 8) {
    const Eigen::Vector3d a = pose * scan.origin(i).cast<double>(), b = pose * scan.points[i].cast<double>();
    const double length = (b - a).norm();
    const Eigen::Vector3d d = (b - a) / length;
    ++rays;
    for (double t = 0.3; t < length - 0.25; t += 0.06) {
      if (map8.contains(voxel_at(Eigen::Vector3d(a + t * d), 0.08))) { ++through; break; }
    }
  }
  return double(through) / rays;
}

void run(const WorldConfig& config, int foreign, int changed, int queries, std::size_t most, double ratio) {
  const double t0 = cpu_ms();
  const TestFloor world = make_test_floor(config);
  const int people = changed ? 3 : 0;
  BuildingConfig later = config.wing;
  later.changed = changed;
  if (foreign) later.seed = foreign;
  const Building now = make_floor(later, config.wings);
  const double t1 = cpu_ms();
  const GlobalMap global(world.map, 0.04, 9.0);
  const TolerantMap& map = global.tolerant();
  const double t2 = cpu_ms();
  const double t3 = cpu_ms();
  const SurfelMap surfels(world.map);
  VoxelMap map8(0.08);
  world.map.for_each_voxel([&](const Voxel& v) { map8.insert({floor_div(v.x, 4), floor_div(v.y, 4), floor_div(v.z, 4)}); });
  int in_list = 0, by_violation = 0, by_fit = 0, by_sum = 0;
  std::printf("%s: %zu voxels, world %.1f s, preparation %.0f + %.0f + %.0f ms, %d x %d x %d\n", world.name.c_str(),
              world.map.size(), (t1 - t0) * 1e-3, t2 - t1, t3 - t2, cpu_ms() - t3, map.size_x(), map.size_y(), map.size_z());
  Random random(4711, static_cast<std::uint64_t>(config.wing.seed));
  std::vector<double> times, errors, turns, e0, sw, lf, ce, leaves;
  int right = 0, right0 = 0, certified = 0;
  for (int q = 0; q < queries; ++q) {
    Pose2 truth = free_pose(world, random);
    for (int tries = 0; tries < 100000 && now.clearance_m({truth.x_m, truth.y_m}, 0.05, 1.0) < 0.35; ++tries) truth = free_pose(world, random);
    const Cloud scan = scan_at(now, truth, people, 1'000'000 + static_cast<std::uint64_t>(q));
    const double start = cpu_ms();
    const auto points = global.choose_points(scan.points, most);
    SearchConfig gc;
    gc.mode_ratio = ratio;
    gc.max_nodes = 40000;
    gc.mode_distance_m = 0.5;
    gc.mode_turn_rad = 0.2;
    gc.max_modes = static_cast<std::size_t>(std::atoi(std::getenv("K") ? std::getenv("K") : "3"));
    const SearchResult match = global_search(global, points, gc);
    double best_fit = -1;
    Pose2 best;
    double bv = -1e9, bf = -1e9, bs = -1e9; Pose2 pv, pf, ps; bool listed = false;
    for (const auto& m : match.modes) {
      const Refinement r = refine(surfels, points, m.pose);
      if (r.inlier_share > best_fit) best_fit = r.inlier_share, best = r.pose;
      const double v = violations(map8, scan, r.pose), o = double(m.overlap) / double(points.size());
      if (o - v > bv) bv = o - v, pv = r.pose;
      if (r.inlier_share > bf) bf = r.inlier_share, pf = r.pose;
      if (o - v + 0.5 * r.inlier_share > bs) bs = o - v + 0.5 * r.inlier_share, ps = r.pose;
      const bool is = distance_m(r.pose, truth) < 0.05;
      listed |= is;
      if (std::getenv("V")) std::printf("   %s o %.3f v %.3f fit %.3f\n", is ? "TRUE" : "    ", o, v, r.inlier_share);
    }
    in_list += listed;
    const auto hit = [&](const Pose2& p) { return distance_m(p, truth) < 0.05 && turn_rad(p, truth) < 0.5 / 57.3; };
    by_violation += hit(pv); by_fit += hit(pf); by_sum += hit(ps);
    best = pv;
    if (std::getenv("C")) {
      const auto o = [&](std::size_t i) { return match.modes.size() > i ? double(match.modes[i].overlap) / double(points.size()) : 0.0; };
      std::printf("C %d %.3f %.3f\n", foreign ? -1 : hit(match.modes[0].pose) || distance_m(match.modes[0].pose, truth) < 0.1, o(0), o(1));
    }
    times.push_back(cpu_ms() - start);
    leaves.push_back(double(match.poses_examined) / 512.0 - double(match.lattice_poses) / 512.0 / 512.0);
    certified += match.certified && match.complete;
    if (match.modes.empty()) continue;
    const double error = distance_m(best, truth), turn = turn_rad(best, truth);
    right0 += distance_m(match.modes[0].pose, truth) < 0.08;
    if (error < 0.05 && turn < 0.5 / 57.3) ++right, errors.push_back(error), turns.push_back(turn);
    else std::printf("  wrong: %.2f %.2f %.2f: %zu points, off %.2f m, fit %.3f overlap %d second %d of %zu\n", truth.x_m, truth.y_m, truth.yaw_rad, scan.points.size(), error, best_fit, match.modes[0].overlap, match.modes.size() > 1 ? match.modes[1].overlap : 0, points.size());
  }
  std::printf("  in list %d, by overlap-violations %d, by fit %d, by sum %d\n", in_list, by_violation, by_fit, by_sum);
  std::printf("  right %d (before %d) of %d, certified %d, error median %.1f mm %.3f deg, CPU ms median %.1f p95 %.1f max %.1f; cells %.1f sweep %.1f leaves %.1f (max %.1f), leaves %.0f p95 %.0f\n",
              right, right0, queries, certified, 1e3 * percentile(errors, 0.5), 57.3 * percentile(turns, 0.5),
              percentile(times, 0.5), percentile(times, 0.95), percentile(times, 1.0), percentile(ce, .5), percentile(sw, .5), percentile(lf, .5), percentile(lf, 1.), percentile(leaves, .5), percentile(leaves, .95));
}

void hall(std::size_t most, double ratio, double cell, double range) {
  const ScanFolder scans(std::filesystem::path(std::getenv("VOXLIST_DATA")) / "hall");
  VoxelMap vm(kFinestResolution_m);
  for (std::size_t i = 0; i < scans.size(); i += 2) {
    const Pose3 T = scans.truth(i).value();
    for (const auto& p : scans.read(i).points) {
      const Eigen::Vector3d q = T * p.cast<double>();
      if (in_lattice(q, kFinestResolution_m)) vm.insert(voxel_at(q, kFinestResolution_m));
    }
  }
  const double t1 = cpu_ms();
  const GlobalMap global(vm, cell, range);
  const TolerantMap& map = global.tolerant();
  const SurfelMap surfels(vm);
  std::printf("hall: prep %.0f ms, %d x %d x %d\n", cpu_ms() - t1, map.size_x(), map.size_y(), map.size_z());
  std::vector<double> times, errors, sw, lf, leaves, first, second;
  int right = 0, right0 = 0, n = 0, certified = 0;
  for (std::size_t i = 1; i < scans.size(); i += 2) {
    Cloud scan = scans.read(i);
    std::erase_if(scan.points, [&](const auto& p) { return p.template head<2>().norm() > range; });
    const Pose2 truth = to_pose2(scans.truth(i).value());
    const double start = cpu_ms();
    const auto points = global.choose_points(scan.points, most);
    SearchConfig gc;
    gc.mode_ratio = ratio;
    gc.max_nodes = 40000;
    gc.mode_distance_m = 0.5;
    gc.mode_turn_rad = 0.2;
    gc.max_modes = 3;
    const SearchResult match = global_search(global, points, gc);
    Pose2 best;
    double bf = -1;
    for (const auto& m : match.modes) {
      const Refinement r = refine(surfels, points, m.pose);
      if (r.inlier_share > bf) bf = r.inlier_share, best = r.pose;
    }
    times.push_back(cpu_ms() - start);
    ++n;
    certified += match.certified && match.complete;
    first.push_back(double(match.modes[0].overlap) / double(points.size()));
    if (match.modes.size() > 1) second.push_back(double(match.modes[1].overlap) / double(points.size()));
    right0 += distance_m(match.modes[0].pose, truth) < 0.15;
    leaves.push_back(double(match.poses_examined) / 512.0 - double(match.lattice_poses) / 512.0 / 512.0);
    const double e = distance_m(best, truth);
    if (e < 0.1 && turn_rad(best, truth) < 1 / 57.3) ++right, errors.push_back(e);
  }
  std::printf("  right %d (before %d) of %d certified %d, error %.1f mm, ms median %.1f p95 %.1f max %.1f, sweep %.1f leaves %.1f (%.0f p95 %.0f) first %.3f min %.3f, second n %zu\n", right, right0, n, certified, 1e3 * percentile(errors, .5),
              percentile(times, .5), percentile(times, .95), percentile(times, 1.), percentile(sw, .5), percentile(lf, .5), percentile(leaves, .5), percentile(leaves, .95), percentile(first, .5), percentile(first, 0.), second.size());
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
  if (std::getenv("HALL")) { hall(most, ratio, std::atof(argv[4]), std::atof(argv[5])); return 0; }
  for (int seed : {1, 2}) {
    run(floor_60_40(seed), 0, 0, queries, most, ratio);
    run(floor_60_40(seed), 0, 7, queries, most, ratio);
    run(floor_60_40(seed), 5000, 0, queries, most, ratio);
  }
  if (large > 0) run(floor_200_150(1), 0, 0, large, most, ratio);
}
