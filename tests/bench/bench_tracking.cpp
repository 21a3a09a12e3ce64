// Scans tracked in a window round a prediction, on a simulated floor of 60 x 40 m mapped at true
// poses, and at poses that are a little wrong, as a robot's are: how exact, how long, and how well
// the covariance tells the error. Arguments, each optional: --csv FILE; queries for each case;
// seed. CPU time of one thread.
#include <tbb/global_control.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "tests/bench/figures.h"
#include "tests/bench/test_floor.h"
#include "voxlist/matching/engines/matcher.h"

namespace voxlist::bench {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr double kFound_m = 0.05;
// 95 % of a chi-square with three degrees of freedom are below: so many normalised errors should
// be.
constexpr double kExpected95 = 7.815;

struct Tally {
  std::string scene, name;
  int queries = 0, found = 0, certified = 0;
  std::vector<double> errors_m, turns_rad, normalised, times_ms;

  void add(const matching::Match& match, const Pose2& truth, double ms) {
    ++queries;
    times_ms.push_back(ms);
    certified += match.certified;
    if (match.modes.empty()) return;
    const matching::MatchMode& best = match.modes.front();
    const Eigen::Vector3d off(best.pose.x_m - truth.x_m, best.pose.y_m - truth.y_m,
                              wrap_angle(best.pose.yaw_rad - truth.yaw_rad));
    found += distance_m(best.pose, truth) < kFound_m;
    errors_m.push_back(off.head<2>().norm());
    turns_rad.push_back(std::abs(off.z()));
    if (errors_m.back() < kFound_m)
      normalised.push_back(off.dot(best.covariance.ldlt().solve(off)));
  }

  std::vector<Figure> figures() const {
    const auto figure = [this](const char* measure, double value) {
      return Figure{scene, name, measure, value};
    };
    const auto share = [this](int n) { return static_cast<double>(n) / queries; };
    const auto mean = [this](auto&& value) {
      double sum = 0.0;
      for (const double n : normalised) sum += value(n);
      return sum / std::max<double>(1.0, static_cast<double>(normalised.size()));
    };
    return {figure("queries", queries),
            figure("found_share", share(found)),
            figure("certified_share", share(certified)),
            figure("error_median_mm", 1e3 * percentile(errors_m, 0.5)),
            figure("error_p90_mm", 1e3 * percentile(errors_m, 0.9)),
            figure("error_p99_mm", 1e3 * percentile(errors_m, 0.99)),
            figure("error_max_mm", 1e3 * percentile(errors_m, 1.0)),
            figure("turn_median_deg", kDegrees * percentile(turns_rad, 0.5)),
            figure("turn_p99_deg", kDegrees * percentile(turns_rad, 0.99)),
            figure("nees_mean", mean([](double n) { return n; })),
            figure("nees_in_95_share", mean([](double n) { return n < kExpected95 ? 1.0 : 0.0; })),
            figure("cpu_median_ms", percentile(times_ms, 0.5)),
            figure("cpu_p95_ms", percentile(times_ms, 0.95)),
            figure("cpu_max_ms", percentile(times_ms, 1.0))};
  }
};

// How far the prediction is off, and the window round it.
struct Case {
  const char* name;
  double off_m, off_rad, half_m, half_rad;
  int people;
};

std::vector<Figure> run(const Case& test, const TestFloor& floor, const simulation::Building& now,
                        matching::Matcher& matcher, int queries) {
  simulation::Random random(4711, static_cast<std::uint64_t>(queries));
  Tally tally;
  tally.scene = floor.name;
  tally.name = test.name;
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
    const matching::PoseWindow window{predicted, test.half_m, test.half_m, test.half_rad};
    const Cloud before = scan_at(now, truth, 0, seed + 500'000);
    matcher.match(matching::PreparedScan(before), window);
    const double start_ms = cpu_ms();
    const matching::Match match = matcher.match(matching::PreparedScan(scan), window);
    tally.add(match, truth, cpu_ms() - start_ms);
  }
  print("  " + tally.name, tally.figures());
  return tally.figures();
}

constexpr Case kOff{"off 0.3 m, 10 deg", 0.3, 0.17, 0.4, 0.3, 0};
constexpr Case kChanged{"off 0.3 m, 10 deg, changed, three people", 0.3, 0.17, 0.4, 0.3, 3};
constexpr Case kFarOff{"off 1 m, 90 deg", 1.0, std::numbers::pi / 2.0, 1.2, std::numbers::pi, 0};

std::vector<Figure> run_floor(const TestFloorConfig& config, std::span<const Case> tests,
                              int queries) {
  const TestFloor floor = make_test_floor(config);
  const simulation::Building changed = later(config);
  const auto matcher = matching::make_matcher(floor.map, {});
  std::printf("%s: %zu voxels\n", floor.name.c_str(), floor.map.occupied.size());
  std::vector<Figure> figures;
  for (const Case& test : tests) {
    const simulation::Building& now = test.people > 0 ? changed : floor.building;
    const auto more = run(test, floor, now, *matcher, queries);
    figures.insert(figures.end(), more.begin(), more.end());
  }
  return figures;
}

}  // namespace
}  // namespace voxlist::bench

int main(int argc, char** argv) {
  using namespace voxlist::bench;
  const auto csv = take_csv_option(argc, argv);
  // What ctest passes to all benchmarks: one small run.
  const bool brief = argc > 1 && std::string(argv[1]).starts_with("--");
  const int queries = brief ? 3 : argc > 1 ? std::atoi(argv[1]) : 100;
  const int seed = !brief && argc > 2 ? std::atoi(argv[2]) : 1;
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const TestFloorConfig floor = brief ? floor_16_13(seed) : floor_60_40(seed);
  auto figures = run_floor(floor, std::vector{kOff, kChanged, kFarOff}, queries);
  const auto more = run_floor(misplaced(floor), std::vector{kOff, kChanged}, queries);
  figures.insert(figures.end(), more.begin(), more.end());
  if (csv) append_csv(*csv, "bench_tracking", figures);
}
