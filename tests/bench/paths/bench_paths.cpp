// Paths that the planners of tests/clients find in maps of simulated buildings: whether they find
// one wherever there is one, and whether it touches the true building or leads through what nobody
// saw. Arguments: --csv FILE; errands in each building (10), first seed (1), last seed.
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "tests/bench/figures.h"
#include "tests/bench/paths/grid_paths.h"
#include "tests/bench/paths/octomap_paths.h"

namespace voxlist::bench {
namespace {

std::vector<Figure> figures_of(const std::string& name, const PathTally& tally) {
  const auto figure = [&](const char* measure, int value) {
    return Figure{"simulated building", name, measure, static_cast<double>(value)};
  };
  return {figure("errands", tally.errands),   figure("ways", tally.ways),
          figure("missed", tally.missed),     figure("paths", tally.found),
          figure("collided", tally.collided), figure("through_unknown", tally.through_unknown)};
}

}  // namespace
}  // namespace voxlist::bench

int main(int argc, char** argv) {
  using namespace voxlist::bench;
  const auto csv = take_csv_option(argc, argv);
  // What ctest passes to all benchmarks: one small run.
  const bool brief = argc > 1 && std::string(argv[1]).starts_with("--");
  const auto argument = [&](int i, int otherwise) {
    return argc > i && !brief ? std::atoi(argv[i]) : otherwise;
  };
  std::vector<Figure> figures;
  const auto tell = [&](const std::string& name, const PathTally& tally) {
    const auto more = figures_of(name, tally);
    print(name, more);
    std::fflush(stdout);
    figures.insert(figures.end(), more.begin(), more.end());
  };
  const int errands = argument(1, brief ? 1 : 10), first = argument(2, 1),
            last = argument(3, first);
  for (int seed = first; seed <= last; ++seed) {
    const std::string where = ", seed " + std::to_string(seed);
    tell("octomap_planner, low robot" + where, plan_in_octomap(seed, errands, kLowRobot));
    tell("octomap_planner, tall robot" + where, plan_in_octomap(seed, errands, kTallRobot));
    tell("grid_planner, low robot" + where, plan_in_grid(seed, errands, kLowRobot));
    tell("grid_planner, tall robot" + where, plan_in_grid(seed, errands, kTallRobot));
  }
  if (csv) append_csv(*csv, "bench_paths", figures);
}
