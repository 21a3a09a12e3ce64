// One overlap, three ways: the paper's hash set, the block map, and rows of bits with each set of
// instructions that this processor has. Same scan, map and translations; counts are checked to be
// the same. Two scenes: hall or room at 0.08 m, and a floor of 60 x 40 m at 0.04 m.
#include <algorithm>
#include <cstdint>
#include <unordered_set>

#include "tests/bench/report.h"
#include "tests/bench/scene.h"
#include "tests/bench/test_floor.h"
#include "tests/matching/counting/overlap_rows.h"
#include "tests/system/instruction_sets.h"
#include "voxlist/matching/paper/overlap.h"
#include "voxlist/voxels/occupancy_list.h"

namespace voxlist::bench {
namespace {

struct Hash {
  std::size_t operator()(const Voxel& v) const {
    // The usual mixing of three coordinates by large primes (Teschner et al.).
    return static_cast<std::size_t>(v.x) * 73856093u ^ static_cast<std::size_t>(v.y) * 19349663u ^
           static_cast<std::size_t>(v.z) * 83492791u;
  }
};

using Counts = std::vector<std::uint16_t>;

// The scan turned to its true heading and moved to its true place, its map in three forms, and
// translations around.
struct Inputs {
  std::string name;
  std::vector<Voxel> scan;
  VoxelMap map;
  std::unordered_set<Voxel, Hash> set;
  matching::RowMap rows;
  matching::TranslationBlock block;

  std::size_t poses() const { return static_cast<std::size_t>(block.columns * block.rows); }
};

VoxelMap coarser(const VoxelMap& map, int factor) {
  VoxelMap result(map.resolution_m() * factor);
  map.for_each_voxel([&](const Voxel& v) {
    result.insert({floor_div(v.x, factor), floor_div(v.y, factor), floor_div(v.z, factor)});
  });
  return result;
}

std::vector<Voxel> voxels_of(const std::vector<Eigen::Vector3f>& points_base,
                             const Pose2& T_map_base, double resolution_m) {
  std::vector<Eigen::Vector3f> points;
  for (const auto& p : points_base) points.push_back((T_map_base * p.cast<double>()).cast<float>());
  const OccupancyList list = OccupancyList::from_points(points, resolution_m);
  return {list.voxels().begin(), list.voxels().end()};
}

// The box of what a block of translations reaches.
matching::RowMap rows_for(const VoxelMap& map, const std::vector<Voxel>& scan,
                          const matching::TranslationBlock& block) {
  Voxel low = scan.front(), high = low;
  for (const Voxel& v : scan) {
    low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
    high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
  }
  return matching::RowMap(
      map, {low.x + block.first.x, low.y + block.first.y, low.z},
      {high.x + block.first.x + block.columns, high.y + block.first.y + block.rows, high.z});
}

Inputs make_inputs(const std::string& name, const VoxelMap& finest, int factor,
                   const std::vector<Eigen::Vector3f>& points, const Pose2& truth,
                   const matching::TranslationBlock& block) {
  VoxelMap map = coarser(finest, factor);
  std::unordered_set<Voxel, Hash> set;
  map.for_each_voxel([&](const Voxel& v) { set.insert(v); });
  std::vector<Voxel> scan = voxels_of(points, truth, map.resolution_m());
  matching::RowMap rows = rows_for(map, scan, block);
  return {name, std::move(scan), std::move(map), std::move(set), std::move(rows), block};
}

const Inputs& coarse() {
  static const Inputs made = make_inputs(scene().name + ", 0.08 m", scene().map, 4, scene().scan,
                                         scene().truth, {{-64, -32, 0}, 128, 64});
  return made;
}

const Inputs& fine() {
  static const Inputs made = [] {
    const TestFloor floor = make_test_floor(floor_60_40(1));
    simulation::Random random(1);
    const Pose2 truth = free_pose(floor, random);
    const Cloud scan = scan_at(floor.building, truth, 0, 1);
    return make_inputs(floor.name + ", 0.04 m", floor.map.occupied, 2, scan.points, truth,
                       {{-256, -32, 0}, 512, 64});
  }();
  return made;
}

// Calls count(translation) for each of the block.
template <class Count>
void for_each_translation(const matching::TranslationBlock& block, Counts& counts, Count&& count) {
  std::size_t at = 0;
  for (std::int32_t j = 0; j < block.rows; ++j)
    for (std::int32_t i = 0; i < block.columns; ++i)
      counts[at++] =
          static_cast<std::uint16_t>(count(Voxel{block.first.x + i, block.first.y + j, 0}));
}

void by_hash_set(const Inputs& in, Counts& counts) {
  for_each_translation(in.block, counts, [&in](const Voxel& t) {
    int o = 0;
    for (const Voxel& v : in.scan) o += in.set.contains({v.x + t.x, v.y + t.y, v.z});
    return o;
  });
}

void by_voxel_map(const Inputs& in, Counts& counts) {
  for_each_translation(in.block, counts,
                       [&in](const Voxel& t) { return matching::overlap(in.scan, in.map, t); });
}

template <class Kernel>
void run(benchmark::State& state, const Inputs& in, Kernel&& kernel) {
  state.SetLabel(in.name);
  Counts counts(in.poses()), expected = counts;
  by_voxel_map(in, expected);
  for (auto _ : state) kernel(in, counts);
  if (counts != expected) state.SkipWithError("counts differ from the voxel map's");
  state.counters["scan_voxels"] = static_cast<double>(in.scan.size());
  state.counters["map_voxels"] = static_cast<double>(in.map.size());
  state.counters["poses_per_s"] = benchmark::Counter(static_cast<double>(in.poses()),
                                                     benchmark::Counter::kIsIterationInvariantRate);
}

constexpr const char* kRows[] = {"rows_portable", "rows_avx2", "rows_avx512"};

template <class Kernel>
void add_one(const std::string& name, const Inputs& (*inputs)(), Kernel kernel) {
  benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
    run(state, inputs(), kernel);
  })->Unit(benchmark::kMillisecond);
}

void add_scene(const std::string& scene_name, const Inputs& (*inputs)()) {
  add_one(scene_name + "hash_set", inputs, by_hash_set);
  add_one(scene_name + "voxel_map", inputs, by_voxel_map);
  for (const Instructions instructions : instruction_sets()) {
    const auto by_rows = [instructions](const Inputs& in, Counts& counts) {
      overlap_rows(in.rows, in.scan, in.block, instructions, counts);
    };
    add_one(scene_name + kRows[static_cast<std::size_t>(instructions)], inputs, by_rows);
  }
}

void add() {
  add_scene("coarse/", coarse);
  add_scene("fine/", fine);
}

void compare(Report& report) {
  for (const std::string scene_name : {"coarse/", "fine/"}) {
    report.ratio(scene_name + "voxel_map", scene_name + "hash_set", "poses_per_s");
    for (const char* rows : kRows)
      report.ratio(scene_name + rows, scene_name + "hash_set", "poses_per_s");
  }
}

}  // namespace
}  // namespace voxlist::bench

int main(int argc, char** argv) {
  return voxlist::bench::run_benchmarks(argc, argv, voxlist::bench::add, voxlist::bench::compare);
}
