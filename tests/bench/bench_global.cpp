// Single scans located in whole simulated floors without a guess: how often right, how often clear
// (one place far ahead of the others), how exact, how long; and how often the pose was right before
// it was refined: the first one's, and that of the most overlap. Arguments, each optional: --csv
// FILE; 60x40, 200x150 or 40x25 (dense scans by a laser that sees all round); queries for each
// case; seed; "list" for one line a query. CPU time of one thread.
#include <tbb/global_control.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/bench/figures.h"
#include "tests/bench/test_floor.h"
#include "voxlist/matching/engines/matcher.h"

namespace voxlist::bench {
namespace {

// Support by which the first mode is ahead of the second when there is no doubt.
constexpr double kClear = 0.1;
constexpr double kRight_m = 0.05, kRight_rad = 0.5 * std::numbers::pi / 180.0;

// How far the first mode's support is ahead of the second's.
double margin(const std::vector<matching::MatchMode>& modes) {
  return modes.front().support - (modes.size() > 1 ? std::max(0.0, modes[1].support) : 0.0);
}

bool is_at(const Pose2& pose, const Pose2& truth) {
  return distance_m(pose, truth) < kRight_m && turn_rad(pose, truth) < kRight_rad;
}

const matching::MatchMode& most_overlap(const std::vector<matching::MatchMode>& modes) {
  return *std::max_element(modes.begin(), modes.end(),
                           [](auto& a, auto& b) { return a.overlap_ratio < b.overlap_ratio; });
}

struct Tally {
  std::string scene, name;
  int queries = 0, right = 0, start_right = 0, overlap_right = 0, certified = 0, clear = 0,
      clear_wrong = 0;
  std::vector<double> errors_m, turns_deg, times_ms;

  void add(const matching::Match& match, const Pose2& truth, bool foreign, double ms) {
    ++queries;
    times_ms.push_back(ms);
    certified += match.certified && match.complete;
    if (match.modes.empty()) return;
    const Pose2& pose = match.modes.front().pose;
    const bool is_right = !foreign && is_at(pose, truth);
    const bool is_clear = match.complete && margin(match.modes) >= kClear;
    right += is_right;
    start_right += !foreign && is_at(match.modes.front().start, truth);
    overlap_right += !foreign && is_at(most_overlap(match.modes).start, truth);
    clear += is_clear;
    clear_wrong += is_clear && !is_right;
    if (!is_right) return;
    errors_m.push_back(distance_m(pose, truth));
    turns_deg.push_back(turn_rad(pose, truth) * 180.0 / std::numbers::pi);
  }

  std::vector<Figure> figures() const {
    const auto figure = [this](const char* measure, double value) {
      return Figure{scene, name, measure, value};
    };
    const auto share = [this](int n) { return static_cast<double>(n) / queries; };
    return {figure("queries", queries),
            figure("right_share", share(right)),
            figure("right_before_refinement_share", share(start_right)),
            figure("most_overlap_right_share", share(overlap_right)),
            figure("clear_share", share(clear)),
            figure("clear_and_wrong", clear_wrong),
            figure("certified_share", share(certified)),
            figure("error_median_mm", 1e3 * percentile(errors_m, 0.5)),
            figure("turn_median_deg", percentile(turns_deg, 0.5)),
            figure("cpu_median_ms", percentile(times_ms, 0.5)),
            figure("cpu_p95_ms", percentile(times_ms, 0.95)),
            figure("cpu_max_ms", percentile(times_ms, 1.0))};
  }
};

void list(const matching::Match& match, const Pose2& truth) {
  if (match.modes.empty()) return;
  const matching::MatchMode& best = match.modes.front();
  std::printf("query: off %.3f m, support %.3f, margin %.3f, %zu modes, complete %d\n",
              distance_m(best.pose, truth), best.support, margin(match.modes), match.modes.size(),
              match.complete);
}

struct Case {
  std::string name;
  simulation::Building building;
  bool foreign;
  int people;
};

Cloud scan_in(const TestFloor& floor, const Case& test, const Pose2& pose, std::uint64_t seed) {
  return floor.config.map_of_spheres
             ? sphere_scan_at(test.building, pose, 64'000, test.people, seed)
             : scan_at(test.building, pose, test.people, seed);
}

// Poses leave the robot room in the building as it was mapped, and as it is.
Tally run(const TestFloor& floor, const Case& test, matching::Matcher& matcher, int queries,
          bool listed) {
  simulation::Random random(4711, static_cast<std::uint64_t>(queries));
  Tally tally;
  tally.scene = floor.name;
  tally.name = test.name;
  while (tally.queries < queries) {
    const Pose2 truth = free_pose(floor, random);
    if (test.building.clearance_m({truth.x_m, truth.y_m}, 0.05, 1.0) < 0.35) continue;
    const auto seed = static_cast<std::uint64_t>(1'000'000 + tally.queries);
    const Cloud scan = scan_in(floor, test, truth, seed);
    const double start_ms = cpu_ms();
    const matching::Match match = matcher.match(matching::PreparedScan(scan), std::nullopt);
    tally.add(match, truth, test.foreign, cpu_ms() - start_ms);
    if (listed) list(match, truth);
  }
  print("  " + tally.name, tally.figures());
  return tally;
}

std::vector<Figure> run_floor(const TestFloorConfig& config, int queries, bool listed) {
  const TestFloor floor = make_test_floor(config);
  const std::vector<Case> cases{
      {"as mapped", floor.building, false, 0},
      {"changed, three people", later(config), false, 3},
      {"another building", make_floor(elsewhere(config).wing, config.wings), true, 0}};
  const auto matcher = matching::make_matcher(floor.map, {});
  const double start_ms = cpu_ms();
  const Cloud first = scan_in(floor, cases[0], {}, 1);
  matcher->match(matching::PreparedScan(first), std::nullopt);
  std::printf("%s: %zu voxels, first query with preparation %.0f ms\n", floor.name.c_str(),
              floor.map.occupied.size(), cpu_ms() - start_ms);
  std::vector<Figure> figures;
  for (const Case& test : cases) {
    const auto measured = run(floor, test, *matcher, queries, listed).figures();
    figures.insert(figures.end(), measured.begin(), measured.end());
  }
  return figures;
}

TestFloorConfig floor_named(const std::string& name, int seed) {
  if (name == "16x13") return floor_16_13(seed);
  if (name == "60x40") return floor_60_40(seed);
  if (name == "200x150") return floor_200_150(seed);
  if (name == "40x25") return floor_40_25(seed);
  throw std::invalid_argument("no floor " + name + ": 16x13, 60x40, 200x150, 40x25");
}

}  // namespace
}  // namespace voxlist::bench

int main(int argc, char** argv) {
  using namespace voxlist::bench;
  const auto csv = take_csv_option(argc, argv);
  // What ctest passes to all benchmarks: one small run.
  const bool brief = argc > 1 && std::string(argv[1]).starts_with("--");
  const std::string name = brief ? "16x13" : argc > 1 ? argv[1] : "60x40";
  const int queries = brief ? 3 : argc > 2 ? std::atoi(argv[2]) : 50;
  const int seed = argc > 3 ? std::atoi(argv[3]) : 1;
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const auto figures = run_floor(floor_named(name, seed), queries, argc > 4);
  if (csv) append_csv(*csv, "bench_global", figures);
}
