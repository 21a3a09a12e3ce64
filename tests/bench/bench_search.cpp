// Global localisation of one scan in the whole map, refinement included: the matcher's certified
// search against the paper's filter.
#include "bench/report.h"
#include "bench/scene.h"
#include "matching/matcher.h"
#include "matching/particle_filter.h"
#include "matching/search.h"

namespace voxlist {
namespace {

constexpr int kFinalFactor = 4;  // 0.08 m: the search's lattice, and the paper's best level

const ParticleFilter& filter() {
  static const ParticleFilter made(scene().map, {.final_factor = kFinalFactor});
  return made;
}

const OccupancyMap& occupancy() {
  static const OccupancyMap map{scene().map, VoxelMap(kPassedResolution_m)};
  return map;
}

// How far an answer is from the truth.
void count_error(benchmark::State& state, const Pose2& pose) {
  state.counters["error_m"] = distance_m(pose, scene().truth);
  state.counters["error_rad"] = turn_rad(pose, scene().truth);
}

void count_poses(benchmark::State& state, double poses) {
  state.counters["poses"] = poses;
  // Per second of CPU time, over all threads.
  state.counters["queries_per_cpu_s"] =
      benchmark::Counter(1.0, benchmark::Counter::kIsIterationInvariantRate);
}

void run_search(benchmark::State& state) {
  static const auto matcher = make_matcher(occupancy(), {});
  Match match = matcher->match({0, scene().scan, {}}, std::nullopt);  // makes the map ready
  for (auto _ : state) match = matcher->match({0, scene().scan, {}}, std::nullopt);
  state.counters["certified"] = match.certified;
  if (!match.modes.empty()) count_error(state, match.modes.front().pose);
  count_poses(state, static_cast<double>(match.poses_examined));
}

void run_filter(benchmark::State& state, std::span<const Eigen::Vector3f> points) {
  static const PoseWindow window = whole_map(SearchMap(scene().map));
  ParticleFilterResult result;
  for (auto _ : state) result = filter().localise(points, window);
  state.counters["truncated"] = result.truncated;
  if (!result.particles.empty()) count_error(state, result.particles.front().pose);
  double particles = 0.0;
  for (const auto& level : result.levels) particles += static_cast<double>(level.particles);
  count_poses(state, particles);
}

// The whole scan, as in the paper, and the points that the search gets: thinned, floor and ceiling
// held back.
void run_filter_on_scan(benchmark::State& state) { run_filter(state, scene().scan); }
void run_filter_on_match_points(benchmark::State& state) {
  run_filter(state, choose_match_points(scene().scan, {}).points);
}

void add() {
  const auto named = [](const char* name, void (*function)(benchmark::State&)) {
    benchmark::RegisterBenchmark(name, function)
        ->Unit(benchmark::kMillisecond)
        ->MeasureProcessCPUTime();
  };
  named("search", run_search);
  named("filter/match_points", run_filter_on_match_points);
  named("filter/whole_scan", run_filter_on_scan);
}

void compare(Report& report) {
  for (const char* filter_name : {"filter/match_points", "filter/whole_scan"}) {
    report.ratio("search", filter_name, "queries_per_cpu_s");
  }
}

}  // namespace
}  // namespace voxlist

int main(int argc, char** argv) {
  return voxlist::run_benchmarks(argc, argv, voxlist::add, voxlist::compare);
}
