// What tells right places from wrong ones where only those in reach of a prediction are asked for:
// scans of real drives and of simulated floors, in maps of one scan, of few and of many. Each is
// asked about with a prediction as odometry gives it, as the last step does, as at a map's second
// scan, and of nearly nothing; and again with predictions that are metres off or, in a building
// that the map is not of, where nothing is right. Arguments: --csv FILE; scans of each kind, seed,
// and a file for what fit_places.py reads.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/bench/answers.h"
#include "tests/bench/figures.h"
#include "tests/bench/test_floor.h"
#include "voxlist/geometry/elementary.h"
#include "voxlist/io/scans/scan_folder.h"
#include "voxlist/matching/localisation/reach_match.h"

namespace voxlist::bench {
namespace {

// Where a prediction comes from: its standard deviations.
struct Prediction {
  const char* name;
  double sigma_m, sigma_rad;
};
constexpr Prediction kPredictions[] = {
    {"odometry", 0.05, 0.02}, {"step", 0.5, 0.5}, {"first", 0.67, 0.7}, {"far", 8.0, 1.0}};

// A wrong prediction is off by what its window reaches, and so much more (m); its yaw by so much
// (rad, a standard deviation).
constexpr double kLeastOff_m = 0.66, kMostOff_m = 8.16, kOff_rad = 0.3;
// An answer that is off by less is right: the real drives' truth is no more exact.
constexpr double kRight_m = 0.3, kRight_rad = 0.06;
// Right and wrong predictions are asked about alike often. An answer is believed from here on.
constexpr double kInReach = 0.5, kBelieved = 0.9;

bool right(const Pose2& pose, const Pose2& truth) {
  return distance_m(pose, truth) < kRight_m && turn_rad(pose, truth) < kRight_rad;
}

struct Counts {
  int asked = 0, right = 0, believed_right = 0, believed_wrong = 0;

  void add(bool is_right, double said) {
    right += is_right;
    if (said >= kBelieved) ++(is_right ? believed_right : believed_wrong);
  }
};

class Bench {
 public:
  // `answers`: where each answer is written to, for the fit; nullptr: nowhere.
  Bench(int scans, int seed, const char* answers)
      : scans_(scans), seed_(seed), random_(static_cast<std::uint64_t>(seed)) {
    if (!answers) return;
    answers_.open(answers);
    if (!answers_) throw std::runtime_error(std::string("cannot write ") + answers);
    answers_ << "family,seed,prediction,near,right,support,rival,known,overlap\n";
  }

  // Maps of one scan and of a few are of those just before the scan that is asked about; the map of
  // many is of every other scan.
  void drive(const std::string& name, const std::vector<Query>& drive, std::size_t few) {
    const std::size_t step = std::max<std::size_t>(1, drive.size() / static_cast<unsigned>(scans_));
    for (const std::size_t behind : {std::size_t{1}, few})
      for (std::size_t i = behind; i < drive.size(); i += step) {
        const OccupancyMap map = map_of(drive, i - behind, i, 1);
        ask(name + (behind == 1 ? "_one" : "_few"), *matching::make_matcher(map, {}), drive[i]);
      }
    const OccupancyMap map = map_of(drive, 0, drive.size(), 2);
    const auto matcher = matching::make_matcher(map, {});
    for (std::size_t i = 1; i < drive.size(); i += (step + 1) / 2 * 2)
      ask(name + "_many", *matcher, drive[i]);
  }

  void floor(const std::string& name, const TestFloorConfig& config) {
    const TestFloor floor = make_test_floor(config);
    const auto matcher = matching::make_matcher(floor.map, {});
    const bool dense = config.map_of_spheres;
    for (const Kind& kind :
         {Kind{name, false, false, dense, 0}, Kind{name + "_changed", true, false, dense, 3},
          Kind{name + "_foreign", false, true, dense, 0}})
      for (const Query& query : scans_about(kind, floor, now(kind, config), scans_, seed_))
        ask(kind.name, *matcher, query, kind.foreign);
  }

  // Prints what was counted, and gives it as figures.
  std::vector<Figure> finish() const {
    std::vector<Figure> figures;
    for (const auto& [name, c] : counts_) {
      std::printf("%-34s %4d asked: %4d right, believed %4d right and %3d wrong\n", name.c_str(),
                  c.asked, c.right, c.believed_right, c.believed_wrong);
      const auto add = [&](const char* measure, int value) {
        figures.push_back({"drives and floors", name, measure, static_cast<double>(value)});
      };
      add("asked", c.asked);
      add("right", c.right);
      add("believed_right", c.believed_right);
      add("believed_wrong", c.believed_wrong);
    }
    return figures;
  }

 private:
  static OccupancyMap map_of(const std::vector<Query>& drive, std::size_t begin, std::size_t end,
                             std::size_t step) {
    OccupancyMap map;
    for (std::size_t i = begin; i < end; i += step)
      add_scan(drive[i].scan, to_pose3(drive[i].truth), 100.0, map);
    return map;
  }

  void ask(const std::string& family, matching::Matcher& matcher, const Query& query,
           bool foreign = false) {
    const matching::PreparedScan scan(query.scan);
    for (const Prediction& from : kPredictions)
      for (const bool near : {true, false}) {
        if (near && foreign) continue;
        const Eigen::Vector3d sigmas(from.sigma_m, from.sigma_m, from.sigma_rad);
        const UncertainPose predicted{predict(from, query.truth, near, foreign),
                                      sigmas.cwiseAbs2().asDiagonal()};
        const auto found = matching::match_in_reach(matcher, scan, predicted, kInReach);
        Counts& counts = counts_[family + (near ? "" : ", wrong prediction")];
        ++counts.asked;
        if (found.match.modes.empty()) continue;
        const bool is_right = !foreign && right(found.match.modes.front().pose, query.truth);
        counts.add(is_right, found.best());
        write(family, from, near, is_right, found.match.modes);
      }
  }

  Pose2 predict(const Prediction& from, const Pose2& truth, bool near, bool foreign) {
    const auto way = elementary::sine_cosine(random_.uniform(-std::numbers::pi, std::numbers::pi));
    if (foreign) return truth;
    if (near)
      return {truth.x_m + from.sigma_m * random_.normal(),
              truth.y_m + from.sigma_m * random_.normal(),
              truth.yaw_rad + from.sigma_rad * random_.normal()};
    const double off_m = 3.0 * from.sigma_m + random_.uniform(kLeastOff_m, kMostOff_m);
    return {truth.x_m + off_m * way.cosine, truth.y_m + off_m * way.sine,
            truth.yaw_rad + kOff_rad * random_.normal()};
  }

  void write(const std::string& family, const Prediction& from, bool near, bool is_right,
             const std::vector<matching::MatchMode>& modes) {
    if (!answers_.is_open()) return;
    const matching::Evidence& evidence = modes.front().evidence;
    const int known = evidence.hits + evidence.misses;
    answers_ << family << ',' << seed_ << ',' << from.name << ',' << near << ',' << is_right << ','
             << modes.front().support << ',' << (modes.size() > 1 ? modes[1].support : 0.0) << ','
             << static_cast<double>(known) / std::max(1, evidence.points) << ','
             << modes.front().overlap_ratio << '\n';
  }

  const int scans_, seed_;
  simulation::Random random_;
  std::ofstream answers_;
  std::map<std::string, Counts> counts_;
};

// A recorded drive at the poses of a table; empty where it is not there.
std::vector<Query> recorded(const std::string& name, const char* table) {
  const char* data = std::getenv("VOXLIST_DATA");
  const auto folder =
      std::filesystem::path(data ? data : VOXLIST_SOURCE_DIR "/../shared/data") / name;
  std::vector<Query> drive;
  if (!std::filesystem::exists(folder / table)) return drive;
  const io::ScanFolder scans(folder);
  const io::PoseTable truth = io::read_poses(folder / table);
  const auto rows = scans.match(truth).rows;
  for (std::size_t i = 0; i < scans.size(); ++i)
    if (rows[i]) drive.push_back({scans.read(i), to_pose2(truth.rows[*rows[i]].pose)});
  return drive;
}

void run_drive(Bench& bench, const std::string& name, const char* table, std::size_t few) {
  const auto drive = recorded(name, table);
  if (!drive.empty()) bench.drive(name, drive, few);
}

void run(Bench& bench, int seed) {
  run_drive(bench, "street", "poses_approx.csv", 5);
  run_drive(bench, "stops", "poses.csv", 3);
  run_drive(bench, "hall", "poses.csv", 4);
  bench.floor("ordinary", floor_16_13(seed));
  bench.floor("few", few_scans_floor(seed));
  bench.floor("hotel", hotel_floor(seed));
  bench.floor("dense", floor_40_25(seed));
}

}  // namespace
}  // namespace voxlist::bench

int main(int argc, char** argv) {
  using namespace voxlist::bench;
  const auto csv = take_csv_option(argc, argv);
  // What ctest passes to all benchmarks: one small run.
  const bool brief = argc > 1 && std::string(argv[1]).starts_with("--");
  const auto argument = [&](int i, int otherwise) {
    return !brief && argc > i ? std::max(1, std::atoi(argv[i])) : otherwise;
  };
  const int seed = argument(2, 1);
  Bench bench(argument(1, brief ? 2 : 5), seed, !brief && argc > 3 ? argv[3] : nullptr);
  if (brief)
    bench.floor("ordinary", floor_16_13(seed));
  else
    run(bench, seed);
  const auto figures = bench.finish();
  if (csv) append_csv(*csv, "bench_places", figures);
}
