// Tracking as the localiser does it. First drives of all kinds (drives/kinds.h): what is claimed,
// and what of it is wrong. Then single scans in reach of a wrong prediction, on a simulated floor
// of 60 x 40 m mapped at true poses, and at poses that are a little wrong, as a robot's are: how
// exact, how long, and how well the covariance tells the error. Arguments, each optional: --csv
// FILE; drives of each kind and seed (1; 0: none); queries for each case (0: none); first seed;
// last seed; a part of the kinds' names; "list": one line for each wrong claim. CPU time of one
// thread.
#include <tbb/global_control.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tests/bench/drives/claims.h"
#include "tests/bench/figures.h"
#include "tests/bench/test_floor.h"
#include "voxlist/matching/localisation/reach_match.h"

namespace voxlist::bench {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr double kFound_m = 0.05, kFar_m = 0.3;
// That the robot is in reach, before the scan is looked at: as while tracking.
constexpr double kInReach = 0.995;
// 95 % of a chi-square with three degrees of freedom are below: so many normalised errors should
// be.
constexpr double kExpected95 = 7.815;

struct Tally {
  std::string scene, name;
  int queries = 0, found = 0, certified = 0, sure_right = 0, sure_wrong = 0;
  std::vector<double> errors_m, turns_rad, normalised, times_ms;

  void add(const matching::ReachMatch& reach, const Pose2& truth, double ms) {
    ++queries;
    times_ms.push_back(ms);
    const matching::Match& match = reach.match;
    certified += match.certified;
    if (match.modes.empty()) return;
    const matching::MatchMode& best = match.modes.front();
    const Eigen::Vector3d off(best.pose.x_m - truth.x_m, best.pose.y_m - truth.y_m,
                              wrap_angle(best.pose.yaw_rad - truth.yaw_rad));
    found += distance_m(best.pose, truth) < kFound_m;
    errors_m.push_back(off.head<2>().norm());
    if (reach.best() >= matching::kSureInReach)
      ++(errors_m.back() < kFar_m ? sure_right : sure_wrong);
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
            figure("sure_right", sure_right),
            figure("sure_wrong", sure_wrong),
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

// How far the prediction is off, and what it says of that (standard deviations).
struct Case {
  const char* name;
  double off_m, off_rad, sigma_m, sigma_rad;
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
    const Eigen::Vector3d sigmas(test.sigma_m, test.sigma_m, test.sigma_rad);
    const UncertainPose prior{predicted, sigmas.cwiseAbs2().asDiagonal()};
    // A tracked scan finds the map ready: the one before was taken near by.
    const Cloud before = scan_at(now, truth, 0, seed + 500'000);
    matching::match_in_reach(matcher, matching::PreparedScan(before), prior, kInReach);
    const double start_ms = cpu_ms();
    const auto reach =
        matching::match_in_reach(matcher, matching::PreparedScan(scan), prior, kInReach);
    tally.add(reach, truth, cpu_ms() - start_ms);
  }
  print("  " + tally.name, tally.figures());
  return tally.figures();
}

constexpr Case kOff{"off 0.3 m, 10 deg", 0.3, 0.17, 0.15, 0.1, 0};
constexpr Case kChanged{"off 0.3 m, 10 deg, changed, three people", 0.3, 0.17, 0.15, 0.1, 3};
constexpr Case kFarOff{"off 1 m, 90 deg", 1.0, std::numbers::pi / 2.0, 0.5, 1.0, 0};

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

// What is asked of the drives.
struct Asked {
  int drives = 1, first_seed = 1, last_seed = 1;
  std::string names;  // kinds whose names hold this
  bool list = false;
};

std::vector<Figure> figures_of(const DriveSpec& spec, const DriveClaims& c) {
  std::vector<Figure> figures;
  const auto add = [&](const char* measure, double value) {
    figures.push_back({"drives", spec.name, measure, value});
  };
  const double scans = std::max(1, c.scans);
  add("scans", c.scans);
  add("tracking_share", c.tracking / scans);
  add("within_0.1m_share", c.near / scans);
  add("wrong_by_0.3m", c.far);
  add("wrong_by_3_sigma", c.beyond_claim);
  add("ambiguous", c.ambiguous);
  add("lost", c.lost);
  add("bad_rows", c.bad_rows);
  add("tracking_at_next", c.at_next);
  add("tracking_within_two", c.within_two);
  add("carried", c.carried);
  add("noticed", c.noticed);
  add("localise_median_ms", percentile(c.localise_ms, 0.5));
  add("localise_p95_ms", percentile(c.localise_ms, 0.95));
  add("map_median_ms", percentile(c.map_ms, 0.5));
  return figures;
}

constexpr const char* kHead =
    "kind                                            scans  TRACKING  within 0.1 m  wrong: far, "
    "beyond claim  AMBIGUOUS  LOST  after bad: next, second  carried: noticed  ms: median, p95, "
    "map";

void print_row(const std::string& name, const DriveClaims& c) {
  const double percent = 100.0 / std::max(1, c.scans);
  std::printf("%-46s %6d  %6.1f %%  %10.1f %%  %10d, %12d  %9d  %4d  %4d: %4d, %6d", name.c_str(),
              c.scans, c.tracking * percent, c.near * percent, c.far, c.beyond_claim, c.ambiguous,
              c.lost, c.bad_rows, c.at_next, c.within_two);
  std::printf("  %7d: %7d  %8.1f, %5.1f, %5.1f\n", c.carried, c.noticed,
              percentile(c.localise_ms, 0.5), percentile(c.localise_ms, 0.95),
              percentile(c.map_ms, 0.5));
  std::fflush(stdout);
}

// Seed by seed for the drives in a finished map: making that takes longer than the drives.
std::vector<DriveClaims> drive_all(const std::vector<DriveSpec>& specs, const Asked& asked,
                                   Reliability& reliability) {
  std::vector<DriveClaims> claims(specs.size());
  for (int seed = asked.first_seed; seed <= asked.last_seed; ++seed) {
    std::optional<TestFloor> floor;
    for (std::size_t k = 0; k < specs.size(); ++k) {
      if (specs[k].name.find(asked.names) == std::string::npos) continue;
      if (specs[k].mapped && !floor) floor = make_test_floor(floor_16_13(seed));
      for (int i = 0; i < asked.drives; ++i)
        claims[k].add(claims_of(specs[k], seed, i, specs[k].mapped ? &floor->map : nullptr,
                                reliability, asked.list));
    }
  }
  return claims;
}

std::vector<Figure> run_drives(const Asked& asked) {
  const std::vector<DriveSpec> specs = all_drives();
  Reliability reliability;
  std::vector<Figure> figures;
  const auto claims = drive_all(specs, asked, reliability);
  std::printf("drives, seeds %d to %d, %d of each kind\n%s\n", asked.first_seed, asked.last_seed,
              asked.drives, kHead);
  DriveClaims all;
  for (std::size_t k = 0; k < specs.size(); ++k) {
    if (claims[k].scans == 0) continue;
    print_row(specs[k].name, claims[k]);
    all.add(claims[k]);
    const auto more = figures_of(specs[k], claims[k]);
    figures.insert(figures.end(), more.begin(), more.end());
  }
  print_row("all", all);
  reliability.print();
  return figures;
}

}  // namespace
}  // namespace voxlist::bench

int main(int argc, char** argv) {
  using namespace voxlist::bench;
  const auto csv = take_csv_option(argc, argv);
  // What ctest passes to all benchmarks: one small run.
  const bool brief = argc > 1 && std::string(argv[1]).starts_with("--");
  const auto argument = [&](int i, int otherwise) {
    return !brief && argc > i ? std::atoi(argv[i]) : otherwise;
  };
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const int queries = argument(2, brief ? 3 : 0), seed = argument(3, 1);
  const Asked asked{argument(1, 1), seed, argument(4, seed),
                    brief      ? "mapped"
                    : argc > 5 ? argv[5]
                               : "",
                    argc > 6};
  std::vector<Figure> figures = run_drives(asked);
  const auto ask = [&](const TestFloorConfig& config, const std::vector<Case>& cases) {
    const auto more = run_floor(config, cases, queries);
    figures.insert(figures.end(), more.begin(), more.end());
  };
  if (queries > 0) {
    const TestFloorConfig floor = brief ? floor_16_13(seed) : floor_60_40(seed);
    ask(floor, {kOff, kChanged, kFarOff});
    ask(misplaced(floor), {kOff, kChanged});
  }
  if (csv) append_csv(*csv, "bench_tracking", figures);
}
