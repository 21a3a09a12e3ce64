// The paper's filter, level by level: particles per second of weighing, pruning and re-sampling.
#include <cstdio>
#include <string>

#include "bench/report.h"
#include "bench/scene.h"
#include "matching/particle_filter.h"

namespace voxlist {
namespace {

// "An order of 10,000 particles per second can be assessed on a standard 2 GHz computer" (section
// III).
constexpr double kPaperParticlesPerSecond = 10'000.0;

// Small enough that floor and ceiling, which fit at every pose, do not fill the memory.
constexpr PoseWindow window_around(const Pose2& pose) { return {pose, 0.7, 0.7, 0.15}; }

// The filter stopped before one level.
struct Level {
  PoseLattice lattice;
  ParticleSet particles;
  const VoxelMap& map;
};

const ParticleFilter& filter() {
  static const ParticleFilter made(scene().map);
  return made;
}

std::vector<Level> make_levels() {
  std::vector<Level> levels;
  PoseLattice lattice(filter().maps().front().resolution_m(), horizontal_radius_m(scene().scan));
  ParticleSet particles = uniform_poses(lattice, window_around(scene().truth));
  for (const VoxelMap& map : filter().maps()) {
    levels.push_back({lattice, particles, map});
    prune(particles, 0.8, update_weights(particles, lattice, map, scene().scan).max_weight);
    keep_heaviest(particles, 20'000);
    lattice = lattice.finer();
    particles = resample(particles, lattice);
  }
  return levels;
}

const std::vector<Level>& levels() {
  static const std::vector<Level> made = make_levels();
  return made;
}

void run_level(benchmark::State& state, std::size_t index) {
  const Level& level = levels()[index];
  Weighing weighing;
  for (auto _ : state) {
    ParticleSet particles = level.particles;
    weighing = update_weights(particles, level.lattice, level.map, scene().scan);
    prune(particles, 0.8, weighing.max_weight);
    keep_heaviest(particles, 20'000);
    benchmark::DoNotOptimize(resample(particles, level.lattice.finer()));
  }
  const auto particles = static_cast<double>(level.particles.size());
  state.counters["particles"] = particles;
  state.counters["scan_voxels"] = static_cast<double>(weighing.look_ups) / particles;
  state.counters["rotations"] = static_cast<double>(weighing.rotations);
  using benchmark::Counter;
  state.counters["particles_per_s"] = Counter(particles, Counter::kIsIterationInvariantRate);
  state.counters["of_paper"] =
      Counter(particles / kPaperParticlesPerSecond, Counter::kIsIterationInvariantRate);
}

void add() {
  static const char* const kNames[] = {"1.28m", "0.64m", "0.32m", "0.16m",
                                       "0.08m", "0.04m", "0.02m"};
  for (std::size_t i = 0; i < std::size(kNames); ++i) {
    const std::string suffix = i == 0 ? "/smoke" : "";
    benchmark::RegisterBenchmark((std::string("level/") + kNames[i] + suffix).c_str(),
                                 [i](benchmark::State& state) { run_level(state, i); })
        ->Unit(benchmark::kMillisecond);
  }
}

void compare(Report&) {
  std::printf("the paper: %.0f particles per second\n", kPaperParticlesPerSecond);
}

}  // namespace
}  // namespace voxlist

int main(int argc, char** argv) {
  return voxlist::run_benchmarks(argc, argv, voxlist::add, voxlist::compare);
}
