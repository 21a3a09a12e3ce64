// Single scans located in whole simulated floors without a guess: how often right, how often sure,
// how exact, how long. Arguments: queries for each case, first seed, and "list" for one line a
// query. CPU time of one thread.
#include <tbb/global_control.h>
#include <time.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <numbers>

#include "bench/test_floor.h"
#include "matching/matcher.h"

namespace voxlist {
namespace {

constexpr double kRight_m = 0.05, kRight_rad = 0.5 * std::numbers::pi / 180.0;

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

struct Tally {
  int queries = 0, right = 0, certified = 0, sure = 0, sure_wrong = 0;
  std::vector<double> errors_m, times_ms;

  void add(const Match& match, const Pose2& truth, bool foreign, double ms) {
    ++queries;
    times_ms.push_back(ms);
    certified += match.certified && match.complete;
    if (match.modes.empty()) return;
    const Pose2& pose = match.modes.front().pose;
    const double error_m = distance_m(pose, truth);
    const bool is_right = !foreign && error_m < kRight_m && turn_rad(pose, truth) < kRight_rad;
    const bool is_sure = match.complete && match.rivalry <= 1.0;
    right += is_right;
    sure += is_sure;
    sure_wrong += is_sure && !is_right;
    if (is_right) errors_m.push_back(error_m);
  }

  void print(const std::string& name) const {
    std::printf(
        "%-34s right %3d of %3d, sure %3d (wrong %d), certified %3d, error median %.1f mm, CPU ms "
        "median %.0f p95 %.0f max %.0f\n",
        name.c_str(), right, queries, sure, sure_wrong, certified, 1e3 * percentile(errors_m, 0.5),
        percentile(times_ms, 0.5), percentile(times_ms, 0.95), percentile(times_ms, 1.0));
    std::fflush(stdout);
  }
};

void list(const Match& match, const Pose2& truth) {
  if (match.modes.empty()) return;
  double rival_overlap = 0.0, rival_fit = 0.0;
  for (std::size_t i = 1; i < match.modes.size(); ++i) {
    rival_overlap = std::max(rival_overlap, match.modes[i].overlap);
    rival_fit = std::max(rival_fit, match.modes[i].fit);
  }
  const MatchMode& best = match.modes.front();
  std::printf("query: off %.3f m, overlap %.3f then %.3f, fit %.3f then %.3f, complete %d\n",
              distance_m(best.pose, truth), best.overlap, rival_overlap, best.fit, rival_fit,
              match.complete);
}

// Scans of `now` in the floor's map. Poses leave the robot room in both.
void run(const std::string& name, const TestFloor& floor, Matcher& matcher, const Building& now,
         bool foreign, int people, int queries, bool listed) {
  Random random(4711, static_cast<std::uint64_t>(queries));
  Tally tally;
  while (tally.queries < queries) {
    const Pose2 truth = free_pose(floor, random);
    if (now.clearance_m({truth.x_m, truth.y_m}, 0.05, 1.0) < 0.35) continue;
    const auto seed = static_cast<std::uint64_t>(1'000'000 + tally.queries);
    const Cloud scan = scan_at(now, truth, people, seed);
    const double start_ms = cpu_ms();
    const Match match = matcher.match(scan, std::nullopt);
    tally.add(match, truth, foreign, cpu_ms() - start_ms);
    if (listed) list(match, truth);
  }
  tally.print(name);
}

void run_floor(const TestFloorConfig& config, int queries, bool listed) {
  const TestFloor floor = make_test_floor(config);
  const auto matcher = make_matcher(floor.map, {});
  const double start_ms = cpu_ms();
  matcher->match(scan_at(floor.building, {}, 0, 1), std::nullopt);
  std::printf("%s: %zu voxels, first query with preparation %.0f ms\n", floor.name.c_str(),
              floor.map.occupied.size(), cpu_ms() - start_ms);
  TestFloorConfig changed = config, foreign = config;
  changed.wing.changed = 7;
  foreign.wing.seed += 500;
  run("  as mapped", floor, *matcher, floor.building, false, 0, queries, listed);
  run("  changed, three people", floor, *matcher, make_floor(changed.wing, config.wings), false, 3,
      queries, listed);
  run("  another building", floor, *matcher, make_floor(foreign.wing, config.wings), true, 0,
      queries, listed);
}

}  // namespace
}  // namespace voxlist

int main(int argc, char** argv) {
  using namespace voxlist;
  // What ctest passes to all benchmarks: one small run.
  const bool brief = argc > 1 && std::strncmp(argv[1], "--", 2) == 0;
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  if (brief) {
    TestFloorConfig small = floor_60_40(1);
    small.wing.length_m = 16.0;
    small.wing.rooms = 4;
    small.wings = 1;
    small.name = "16 x 13 m";
    run_floor(small, 3, false);
    return 0;
  }
  const int queries = argc > 1 ? std::atoi(argv[1]) : 50;
  const int seed = argc > 2 ? std::atoi(argv[2]) : 1;
  run_floor(floor_60_40(seed), queries, argc > 3);
}
