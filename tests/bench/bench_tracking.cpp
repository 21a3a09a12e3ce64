// Scans tracked in a window round a prediction, on a simulated floor of 60 x 40 m mapped at true
// poses: how exact, how long, and how well the covariance tells the error. Arguments: queries for
// each case, first seed. CPU time of one thread.
#include <tbb/global_control.h>
#include <time.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <numbers>

#include "bench/test_floor.h"
#include "matching/matcher.h"

namespace voxlist {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr double kFound_m = 0.05;

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
  int queries = 0, found = 0, certified = 0;
  std::vector<double> errors_m, turns_rad, normalised, times_ms;

  void add(const Match& match, const Pose2& truth, double ms) {
    ++queries;
    times_ms.push_back(ms);
    certified += match.certified;
    if (match.modes.empty()) return;
    const MatchMode& best = match.modes.front();
    const Eigen::Vector3d off(best.pose.x_m - truth.x_m, best.pose.y_m - truth.y_m,
                              wrap_angle(best.pose.yaw_rad - truth.yaw_rad));
    found += distance_m(best.pose, truth) < kFound_m;
    errors_m.push_back(off.head<2>().norm());
    turns_rad.push_back(std::abs(off.z()));
    if (errors_m.back() < kFound_m)
      normalised.push_back(off.dot(best.covariance.ldlt().solve(off)));
  }

  void print(const char* name) const {
    double sum = 0.0;
    for (const double value : normalised) sum += value;
    const auto below = std::count_if(normalised.begin(), normalised.end(),
                                     [](double value) { return value < 7.815; });
    const auto count = std::max<double>(1.0, static_cast<double>(normalised.size()));
    std::printf(
        "%-28s found %3d of %3d, certified %3d; error mm median %.2f p90 %.1f p99 %.1f max %.1f, "
        "deg median %.3f p99 %.3f; NEES mean %.2f, %.1f %% below 7.8; CPU ms median %.2f p95 %.2f "
        "max %.2f\n",
        name, found, queries, certified, 1e3 * percentile(errors_m, 0.5),
        1e3 * percentile(errors_m, 0.9), 1e3 * percentile(errors_m, 0.99),
        1e3 * percentile(errors_m, 1.0), kDegrees * percentile(turns_rad, 0.5),
        kDegrees * percentile(turns_rad, 0.99), sum / count,
        100.0 * static_cast<double>(below) / count, percentile(times_ms, 0.5),
        percentile(times_ms, 0.95), percentile(times_ms, 1.0));
    std::fflush(stdout);
  }
};

// How far the prediction is off, and the window round it.
struct Case {
  const char* name;
  double off_m, off_rad, half_m, half_rad;
  int people;
};

void run(const Case& test, const TestFloor& floor, const Building& now, Matcher& matcher,
         int queries) {
  Random random(4711, static_cast<std::uint64_t>(queries));
  Tally tally;
  while (tally.queries < queries) {
    const Pose2 truth = free_pose(floor, random);
    if (now.clearance_m({truth.x_m, truth.y_m}, 0.05, 1.0) < 0.35) continue;
    const auto seed = static_cast<std::uint64_t>(1'000'000 + tally.queries);
    const Cloud scan = scan_at(now, truth, test.people, seed);
    const double bearing = random.uniform(-std::numbers::pi, std::numbers::pi);
    const double turn = tally.queries % 2 == 0 ? test.off_rad : -test.off_rad;
    const Pose2 predicted{truth.x_m + test.off_m * std::cos(bearing),
                          truth.y_m + test.off_m * std::sin(bearing),
                          wrap_angle(truth.yaw_rad + turn)};
    // A tracked scan finds the map ready: the one before was taken near by.
    const PoseWindow window{predicted, test.half_m, test.half_m, test.half_rad};
    matcher.match(scan_at(now, truth, 0, seed + 500'000), window);
    const double start_ms = cpu_ms();
    const Match match = matcher.match(scan, window);
    tally.add(match, truth, cpu_ms() - start_ms);
  }
  tally.print(test.name);
}

void run_floor(const TestFloorConfig& config, int queries) {
  const TestFloor floor = make_test_floor(config);
  const auto matcher = make_matcher(floor.map, {});
  std::printf("%s: %zu voxels\n", floor.name.c_str(), floor.map.occupied.size());
  TestFloorConfig changed = config;
  changed.wing.changed = 7;
  const Building later = make_floor(changed.wing, config.wings);
  run({"  off 0.3 m, 10 deg", 0.3, 0.17, 0.4, 0.3, 0}, floor, floor.building, *matcher, queries);
  run({"  the same, changed, people", 0.3, 0.17, 0.4, 0.3, 3}, floor, later, *matcher, queries);
  run({"  off 1 m, 90 deg", 1.0, std::numbers::pi / 2.0, 1.2, std::numbers::pi, 0}, floor,
      floor.building, *matcher, queries);
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
    run_floor(small, 3);
    return 0;
  }
  const int queries = argc > 1 ? std::atoi(argv[1]) : 100;
  const int seed = argc > 2 ? std::atoi(argv[2]) : 1;
  run_floor(floor_60_40(seed), queries);
}
