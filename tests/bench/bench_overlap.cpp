// One overlap, three ways: the paper's hash set, the block map, and the bit-sliced sweep. Same
// scan, map and poses.
#include <algorithm>
#include <cstdint>
#include <limits>
#include <unordered_set>

#include "bench/report.h"
#include "bench/scene.h"
#include "matching/overlap.h"
#include "matching/sweep.h"
#include "voxels/occupancy_list.h"

namespace voxlist {
namespace {

struct Hash {
  std::size_t operator()(const Voxel& v) const {
    // The usual mixing of three coordinates by large primes (Teschner et al.).
    return static_cast<std::size_t>(v.x) * 73856093u ^ static_cast<std::size_t>(v.y) * 19349663u ^
           static_cast<std::size_t>(v.z) * 83492791u;
  }
};

constexpr int kFactor = 4;  // 0.08 m
constexpr SweepWindow kWindow{-64, -32, 128, 64};
constexpr double kPoses = 128.0 * 64.0;
using Counts = std::vector<std::uint16_t>;

// Everything at 0.08 m, the scan turned to its true heading and moved to its true place.
struct Inputs {
  std::vector<Voxel> scan;
  VoxelMap map;
  std::unordered_set<Voxel, Hash> set;
  StridedGrid grid;
};

std::vector<Voxel> turned_scan(double resolution_m) {
  std::vector<Eigen::Vector3f> points;
  for (const auto& p : scene().scan)
    points.push_back((scene().truth * p.cast<double>()).cast<float>());
  const OccupancyList list = OccupancyList::from_points(points, resolution_m);
  return {list.voxels().begin(), list.voxels().end()};
}

StridedGrid grid_of(const VoxelMap& map) {
  constexpr std::int32_t kMost = std::numeric_limits<std::int32_t>::max();
  Voxel low{kMost, kMost, kMost}, high{-kMost, -kMost, -kMost};
  map.for_each_voxel([&](const Voxel& v) {
    low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
    high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
  });
  BitGrid grid(low, high.x - low.x + 1, high.y - low.y + 1, high.z - low.z + 1);
  map.for_each_voxel([&](const Voxel& v) { grid.set(v); });
  return StridedGrid(grid, 1);
}

const Inputs& inputs() {
  static const Inputs made = [] {
    VoxelMap map(scene().map.resolution_m() * kFactor);
    scene().map.for_each_voxel([&](const Voxel& v) {
      map.insert({floor_div(v.x, kFactor), floor_div(v.y, kFactor), floor_div(v.z, kFactor)});
    });
    std::unordered_set<Voxel, Hash> set;
    map.for_each_voxel([&](const Voxel& v) { set.insert(v); });
    StridedGrid grid = grid_of(map);
    std::vector<Voxel> scan = turned_scan(map.resolution_m());
    return Inputs{std::move(scan), std::move(map), std::move(set), std::move(grid)};
  }();
  return made;
}

// Calls count(offset) for every pose of the window.
template <class Count>
void for_each_pose(Counts& counts, Count&& count) {
  for (std::int32_t j = 0; j < kWindow.ny; ++j) {
    for (std::int32_t i = 0; i < kWindow.nx; ++i) {
      counts[static_cast<std::size_t>(j * kWindow.nx + i)] =
          static_cast<std::uint16_t>(count(Voxel{kWindow.x0 + i, kWindow.y0 + j, 0}));
    }
  }
}

void by_hash_set(Counts& counts) {
  for_each_pose(counts, [](const Voxel& t) {
    int o = 0;
    for (const Voxel& v : inputs().scan) o += inputs().set.contains({v.x + t.x, v.y + t.y, v.z});
    return o;
  });
}

void by_voxel_map(Counts& counts) {
  for_each_pose(counts, [](const Voxel& t) { return overlap(inputs().scan, inputs().map, t); });
}

void by_sweep(Counts& counts) { sweep_overlaps(inputs().grid, inputs().scan, kWindow, counts); }

void run(benchmark::State& state, void (*kernel)(Counts&)) {
  state.SetLabel(scene().name);
  Counts counts(static_cast<std::size_t>(kPoses)), expected = counts;
  by_voxel_map(expected);
  for (auto _ : state) kernel(counts);
  if (counts != expected) state.SkipWithError("counts differ from the voxel map's");
  state.counters["scan_voxels"] = static_cast<double>(inputs().scan.size());
  state.counters["poses_per_s"] =
      benchmark::Counter(kPoses, benchmark::Counter::kIsIterationInvariantRate);
}

void add() {
  const auto named = [](const char* name, void (*kernel)(Counts&)) {
    benchmark::RegisterBenchmark(name, [kernel](benchmark::State& state) {
      run(state, kernel);
    })->Unit(benchmark::kMillisecond);
  };
  named("hash_set", by_hash_set);
  named("voxel_map", by_voxel_map);
  named("sweep", by_sweep);
}

void compare(Report& report) {
  report.ratio("voxel_map", "hash_set", "poses_per_s");
  report.ratio("sweep", "hash_set", "poses_per_s");
  report.ratio("sweep", "voxel_map", "poses_per_s");
}

}  // namespace
}  // namespace voxlist

int main(int argc, char** argv) {
  return voxlist::run_benchmarks(argc, argv, voxlist::add, voxlist::compare);
}
