// The paper's filter, level by level: particles per second of weighing, pruning and re-sampling.
#include <string>
#include <utility>
#include <vector>

#include "tests/bench/report.h"
#include "tests/bench/scene.h"
#include "voxlist/matching/paper/particle_filter.h"
#include "voxlist/matching/search/pose_window.h"

namespace voxlist::bench {
namespace {

// "In this manner an order of 10,000 particles per second can be assessed on a standard 2 GHz
// computer" (section III).
constexpr double kPaperParticlesPerSecond = 10'000.0;

// As many parents as the filter's default bound lets through.
constexpr matching::ParticleFilterConfig kConfig;
constexpr std::size_t kMaxParents = kConfig.max_particles / matching::kChildren;

const matching::ParticleFilter& filter() {
  static const matching::ParticleFilter made(scene().map, kConfig);
  return made;
}

// The filter stopped before one level.
struct Level {
  matching::PoseLattice lattice;
  matching::ParticleSet particles;
  const VoxelMap& map;

  // Weighs the particles and makes those of the level below.
  matching::ParticleSet step(matching::Weighing& weighing) const {
    matching::ParticleSet next = particles;
    weighing = matching::update_weights(next, lattice, map, scene().scan);
    matching::prune(next, kConfig.prune_share, weighing.max_weight);
    matching::keep_heaviest(next, kMaxParents);
    return matching::resample(next, lattice.finer());
  }
};

// Levels are made when they are first asked for.
class Levels {
 public:
  explicit Levels(const matching::PoseWindow& window) {
    const matching::PoseLattice top(filter().maps().front().resolution_m(),
                                    matching::horizontal_radius_m(scene().scan));
    made_.push_back({top, matching::uniform_poses(top, window), filter().maps().front()});
  }

  const Level& at(std::size_t index) {
    while (made_.size() <= index) {
      matching::Weighing weighing;
      matching::ParticleSet next = made_.back().step(weighing);
      made_.push_back(
          {made_.back().lattice.finer(), std::move(next), filter().maps()[made_.size()]});
    }
    return made_[index];
  }

 private:
  std::vector<Level> made_;
};

// The whole map, as when the robot is lost, and the surroundings of a last pose, as when it tracks.
Levels& global() {
  static Levels made(matching::whole_map(scene().map));
  return made;
}

Levels& local() {
  static Levels made({scene().truth, 0.7, 0.7, 0.15});
  return made;
}

void run(benchmark::State& state, const Level& level) {
  state.SetLabel(scene().name);
  matching::Weighing weighing;
  for (auto _ : state) benchmark::DoNotOptimize(level.step(weighing));
  const auto particles = static_cast<double>(level.particles.size());
  state.counters["particles"] = particles;
  state.counters["scan_voxels"] = static_cast<double>(weighing.look_ups) / particles;
  state.counters["rotations"] = static_cast<double>(weighing.rotations);
  state.counters["particles_per_s"] =
      benchmark::Counter(particles, benchmark::Counter::kIsIterationInvariantRate);
}

constexpr const char* kLevels[] = {"1.28m", "0.64m", "0.32m", "0.16m", "0.08m", "0.04m", "0.02m"};

void add_levels(const std::string& window, Levels& (*levels)()) {
  for (std::size_t i = 0; i < std::size(kLevels); ++i) {
    const auto measure = [=](benchmark::State& state) { run(state, levels().at(i)); };
    benchmark::RegisterBenchmark((window + kLevels[i]).c_str(), measure)
        ->Unit(benchmark::kMillisecond);
  }
}

void add() {
  add_levels("global/", global);
  add_levels("local/", local);
}

void compare(Report& report) {
  for (const std::string window : {"global/", "local/"}) {
    for (const char* level : kLevels) {
      report.ratio_to(kPaperParticlesPerSecond, "the paper's 10000", window + level,
                      "particles_per_s");
    }
  }
}

}  // namespace
}  // namespace voxlist::bench

int main(int argc, char** argv) {
  return voxlist::bench::run_benchmarks(argc, argv, voxlist::bench::add, voxlist::bench::compare);
}
