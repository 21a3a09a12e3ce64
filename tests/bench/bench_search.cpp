// Global localisation of single scans, no guess: the matcher as the localiser uses it, refinement
// included, against the paper's filter stopped at 0.04 m, on the same scans of the same floor.
// Arguments: queries (1), seed of the floor (1), and --csv FILE. CPU time of one thread.
//
// The filter takes minutes for a query: what it once took on this machine is kept in the state
// folder, in bench_search_filter.csv, and only what is not there is run. Delete it to measure anew.
#include <tbb/global_control.h>
#include <time.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <numbers>

#include "tests/bench/figures.h"
#include "tests/bench/test_floor.h"
#include "voxlist/matching/engines/matcher.h"
#include "voxlist/matching/paper/particle_filter.h"
#include "voxlist/system/state_folder.h"

namespace voxlist::bench {
namespace {

constexpr int kFinalFactor = 2;  // 0.04 m
constexpr double kRight_m = 0.05, kRight_rad = 0.5 * std::numbers::pi / 180.0;

double cpu_s() { return 1e-3 * cpu_ms(); }

struct Answer {
  double seconds = 0.0;
  double error_m = 0.0, error_rad = 0.0;  // infinite when there was none

  bool right() const { return error_m < kRight_m && error_rad < kRight_rad; }
};

Answer answer(double seconds, const Pose2* pose, const Pose2& truth) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  if (pose == nullptr) return {seconds, kNone, kNone};
  return {seconds, distance_m(*pose, truth), turn_rad(*pose, truth)};
}

Answer ask_ours(matching::Matcher& matcher, const Cloud& scan, const Pose2& truth) {
  const double start = cpu_s();
  const matching::Match match = matcher.match(matching::PreparedScan(scan), std::nullopt);
  return answer(cpu_s() - start, match.modes.empty() ? nullptr : &match.modes.front().pose, truth);
}

Answer ask_filter(const TestFloor& floor, const Cloud& scan, const Pose2& truth) {
  static const matching::ParticleFilter filter(floor.map.occupied, {.final_factor = kFinalFactor});
  const Eigen::Vector2d middle = (floor.low + floor.high) / 2.0,
                        half = (floor.high - floor.low) / 2.0;
  const matching::PoseWindow everywhere{
      {middle.x(), middle.y(), 0.0}, half.x(), half.y(), std::numbers::pi};
  const double start = cpu_s();
  const auto found = filter.localise(scan.points, everywhere);
  return answer(cpu_s() - start, found.particles.empty() ? nullptr : &found.particles.front().pose,
                truth);
}

// What the filter answered before: rows machine,floor,query,seconds,error_m,error_rad.
class FilterLog {
 public:
  FilterLog(std::string file, const std::string& floor)
      : file_(std::move(file)), prefix_('"' + machine() + "\",\"" + floor + "\",") {
    std::ifstream in(file_);
    for (std::string line; std::getline(in, line);) {
      if (!line.starts_with(prefix_)) continue;
      int query = 0;
      Answer row;
      if (std::sscanf(line.c_str() + prefix_.size(), "%d,%lf,%lf,%lf", &query, &row.seconds,
                      &row.error_m, &row.error_rad) == 4)
        known_[query] = row;
    }
  }

  const Answer* find(int query) const {
    const auto found = known_.find(query);
    return found == known_.end() ? nullptr : &found->second;
  }

  void add(int query, const Answer& row) {
    std::ofstream(file_, std::ios::app) << prefix_ << query << ',' << row.seconds << ','
                                        << row.error_m << ',' << row.error_rad << std::endl;
  }

 private:
  const std::string file_, prefix_;
  std::map<int, Answer> known_;
};

struct Tally {
  double seconds = 0.0;
  int queries = 0, right = 0;

  void add(const Answer& row) {
    seconds += row.seconds;
    ++queries;
    right += row.right();
  }
  double mean_s() const { return seconds / std::max(1, queries); }
};

void print(const char* name, const Answer& row) {
  std::printf("%s %.4f s, off %.3f m %.2f deg%s", name, row.seconds, row.error_m,
              row.error_rad * 180.0 / std::numbers::pi, row.right() ? "" : " WRONG");
}

std::vector<Figure> run(const TestFloorConfig& config, int queries, FilterLog log) {
  const TestFloor floor = make_test_floor(config);
  const auto matcher = matching::make_matcher(floor.map, {});
  const Cloud first = scan_at(floor.building, {}, 0, 1);
  matcher->match(matching::PreparedScan(first), std::nullopt);  // makes the map ready
  simulation::Random random(4711);
  Tally ours, filter;
  for (int query = 0; query < queries; ++query) {
    const Pose2 truth = free_pose(floor, random);
    const Cloud scan = scan_at(floor.building, truth, 0, static_cast<std::uint64_t>(query) + 1);
    const Answer mine = ask_ours(*matcher, scan, truth);
    const Answer* before = log.find(query);
    const Answer its = before ? *before : ask_filter(floor, scan, truth);
    if (!before) log.add(query, its);
    ours.add(mine);
    filter.add(its);
    std::printf("%d: ", query);
    print("ours", mine);
    print(before ? "; filter, before," : "; filter", its);
    std::printf("\n");
    std::fflush(stdout);
  }
  const double ratio = filter.mean_s() / ours.mean_s();
  std::printf(
      "%s, %d queries: ours %.4f s in the mean, %d right; filter %.1f s, %d right; %.0f x\n",
      config.name.c_str(), queries, ours.mean_s(), ours.right, filter.mean_s(), filter.right,
      ratio);
  return {{config.name, "search", "mean_cpu_s", ours.mean_s()},
          {config.name, "search", "right", static_cast<double>(ours.right)},
          {config.name, "filter to 0.04 m", "mean_cpu_s", filter.mean_s()},
          {config.name, "filter to 0.04 m", "right", static_cast<double>(filter.right)},
          {config.name, "search over filter", "speed", ratio},
          {config.name, "search over filter", "queries", static_cast<double>(queries)}};
}

std::string filter_log() {
  std::filesystem::create_directories(state_folder());
  return state_folder() / "bench_search_filter.csv";
}

}  // namespace
}  // namespace voxlist::bench

int main(int argc, char** argv) {
  using namespace voxlist::bench;
  const auto csv = take_csv_option(argc, argv);
  // What ctest passes to all benchmarks: one small run.
  const bool brief = argc > 1 && std::strncmp(argv[1], "--", 2) == 0;
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const int queries = !brief && argc > 1 ? std::atoi(argv[1]) : 1;
  const int seed = !brief && argc > 2 ? std::atoi(argv[2]) : 1;
  const TestFloorConfig config = brief ? floor_16_13(seed) : floor_60_40(seed);
  const std::string file = brief ? "/dev/null" : filter_log();
  const std::vector<Figure> figures = run(config, queries, FilterLog(file, config.name));
  if (csv) append_csv(*csv, "bench_search", figures);
}
