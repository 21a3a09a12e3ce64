// A lost robot, and a tracked one, in the map of a large floor that large_map has made and a mapper
// has built (built.voxlist): memory, CPU time of one thread, and whether it is right. Arguments:
// the map's folder; drives (30 if not given); seed of the drives.
#include <malloc.h>
#include <tbb/global_control.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "tests/bench/answers.h"
#include "tests/bench/figures.h"
#include "tests/bench/large/large_floor.h"
#include "tests/bench/test_drive.h"
#include "voxlist/mapping/built/built_map.h"
#include "voxlist/matching/localisation/localiser.h"

namespace voxlist::bench {
namespace {

double resident_mb() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (word == "VmRSS:") return status >> word, std::stod(word) / 1000.0;
  return 0.0;
}

// The folder's map alone, without what only a mapper keeps.
OccupancyMap map_of(const std::string& folder) {
  mapping::MapBuilder builder({.count_free = true});
  std::vector<StampedPose3> poses;
  mapping::MapStore store(folder, 0, [&](const mapping::Keyframe& keyframe) {
    poses.push_back({keyframe.cloud.utime_us, keyframe.T_map_base});
  });
  const mapping::BuiltOf of{store.map_id(), store.keyframes().places(), poses};
  const std::size_t built = read_built(folder, of, builder);
  std::printf("%zu keyframes, %zu of them built\n", poses.size(), built);
  mapping::add_stored(store.keyframes(), poses, builder, [] {});
  if (built < poses.size()) write_built(folder, of, builder);
  return builder.map();
}

struct Times {
  std::vector<double> ms;
  int right = 0, wrong = 0;

  void add(const matching::Localisation& found, const DriveStep& step, double cost_ms) {
    ms.push_back(cost_ms);
    if (!found.tracking()) return;
    ++(right_mode(found, step.truth, false) == 0 ? right : wrong);
  }

  void print(const char* name) const {
    std::printf(
        "%-22s %5zu scans, TRACKING right %d, wrong %d; CPU ms: median %.1f, p95 %.1f, max %.1f\n",
        name, ms.size(), right, wrong, percentile(ms, 0.5), percentile(ms, 0.95),
        percentile(ms, 1.0));
  }
};

void run(const std::string& folder, int drives, int seed) {
  const TestFloor floor = large_floor(200.0, 150.0, seed_of(folder));
  const OccupancyMap map = map_of(folder);
  ::malloc_trim(0);
  const double map_mb = resident_mb();
  matching::Localiser localiser(map);
  Times first, lost, tracked;
  for (int i = 0; i < drives; ++i) {
    const auto number = static_cast<std::uint64_t>(1000 * seed + i);
    localiser.forget();
    bool is_found = false;
    for (const DriveStep& step :
         drive_through(floor, floor.building, static_cast<DriveKind>(i % 3), 0, number)) {
      const double start_ms = cpu_ms();
      const auto found = localiser.localise(step.scan, step.T_odom_base);
      Times& times = i == 0 && first.ms.empty() ? first : is_found ? tracked : lost;
      times.add(found, step, cpu_ms() - start_ms);
      is_found = is_found || found.tracking();
    }
  }
  std::printf("memory MB: map %.0f, with all that is made of it %.0f\n", map_mb, resident_mb());
  first.print("the first scan of all");
  lost.print("lost");
  tracked.print("tracked");
}

}  // namespace
}  // namespace voxlist::bench

int main(int argc, char** argv) {
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  if (argc < 2) return std::fprintf(stderr, "usage: bench_large FOLDER [DRIVES] [SEED]\n"), 1;
  voxlist::bench::run(argv[1], argc > 2 ? std::atoi(argv[2]) : 30,
                      argc > 3 ? std::atoi(argv[3]) : 1);
}
