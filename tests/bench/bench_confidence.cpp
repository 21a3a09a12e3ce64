// How honest "how sure" is: single scans, drives of ten scans, and kidnapped robots, in ordinary
// floors, hotels, floors of identical rooms, small ones, maps of few scans, and by a laser that
// sees all round; each as mapped, with moved furniture and people, and in a building that the map
// is not of. Arguments: --csv FILE; scans of each kind and floor, drives (and kidnappings) of each
// kind and floor, first seed, last seed, and a file for what fit_confidence.py reads.
#include <tbb/global_control.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>

#include "tests/bench/answers.h"
#include "tests/bench/drives/claims.h"
#include "tests/bench/figures.h"
#include "tests/bench/test_drive.h"
#include "tests/bench/test_floor.h"
#include "voxlist/matching/localisation/localiser.h"

namespace voxlist::bench {
namespace {

// Returns that are shortened where there are short ones.
constexpr double kShort = 0.05;

// What a map is made of.
struct Family {
  std::string name;
  TestFloorConfig (*floor)(int seed);
  int people;  // that stand about where things have changed
};

const std::vector<Family> kFamilies{
    {"ordinary", floor_60_40, 3},          {"hotel", hotel_floor, 2},
    {"identical", identical_floor, 0},     {"small", floor_16_13, 3},
    {"few map scans", few_scans_floor, 3}, {"dense laser", floor_40_25, 3}};

std::vector<Kind> kinds_of(const Family& family) {
  const bool dense = family.floor(1).map_of_spheres;
  std::vector<Kind> kinds{{family.name, false, false, dense, 0}};
  if (family.floor == identical_floor) return kinds;
  kinds.push_back({family.name + " changed", true, false, dense, family.people});
  kinds.push_back({family.name + " changed short", true, false, dense, family.people, kShort});
  kinds.push_back({family.name + " foreign", false, true, dense, 0});
  kinds.push_back({family.name + " foreign short", false, true, dense, 0, kShort});
  return kinds;
}

void add_figures(const std::string& name, const Tally& tally, std::vector<Figure>& figures) {
  const auto add = [&](const char* measure, double value) {
    figures.push_back({"six kinds of floors", name, measure, value});
  };
  add("asked", tally.asked);
  add("tracking_right", tally.tracking_right);
  add("tracking_wrong", tally.tracking_wrong);
  add("ambiguous", tally.ambiguous);
  add("ambiguous_and_right_listed", tally.ambiguous_listed);
  add("lost", tally.lost);
  add("highest_probability_of_a_wrong_one", tally.most_of_wrong);
}

class Bench {
 public:
  // `modes`: where each listed mode is written to, for the fit; nullptr: nowhere.
  Bench(int scans, int drives, const char* modes) : scans_(scans), drives_(drives) {
    if (!modes) return;
    modes_.open(modes);
    if (!modes_) throw std::runtime_error(std::string("cannot write ") + modes);
    modes_ << "kind,seed,query,mode,right,support,even_support,unseen\n";
  }

  void floor(const Family& family, int seed) {
    const TestFloorConfig config = family.floor(seed);
    const TestFloor floor = make_test_floor(config);
    matching::Localiser localiser(floor.map);
    for (const Kind& kind : kinds_of(family)) {
      const simulation::Building building = now(kind, config);
      singles(kind, floor, building, localiser, seed);
      // Those who drive have the scanner with the mirror.
      if (kind.dense) continue;
      drives(kind, floor, building, localiser, seed);
      kidnappings(kind, floor, building, localiser, seed);
    }
  }

  // Prints what was counted, and gives it as figures.
  std::vector<Figure> finish() const {
    std::vector<Figure> figures;
    const auto show = [&](const std::map<std::string, Tally>& tallies, const char* what) {
      for (const auto& [name, tally] : tallies) {
        tally.print(name + what);
        add_figures(name + what, tally, figures);
      }
    };
    show(singles_, "");
    show(drives_by_kind_, ", driving");
    show(kidnapped_, ", kidnapped");
    reliability_.print();
    std::fflush(stdout);
    return figures;
  }

 private:
  void singles(const Kind& kind, const TestFloor& floor, const simulation::Building& building,
               matching::Localiser& localiser, int seed) {
    const auto queries = scans_about(kind, floor, building, scans_, seed);
    for (int i = 0; i < scans_; ++i) {
      const auto& [scan, truth] = queries[static_cast<std::size_t>(i)];
      const matching::Localisation result = localiser.locate(scan);
      singles_[kind.name].add(result, truth, kind.foreign);
      reliability_.add(result.confidence, right_mode(result, truth, kind.foreign) == 0);
      if (modes_.is_open()) write(kind, seed, i, result, truth);
    }
  }

  void write(const Kind& kind, int seed, int query, const matching::Localisation& result,
             const Pose2& truth) {
    const int listed = right_mode(result, truth, kind.foreign);
    for (std::size_t m = 0; m < result.modes.size(); ++m)
      modes_ << kind.name << ',' << seed << ',' << query << ',' << m << ','
             << (static_cast<int>(m) == listed) << ',' << result.modes[m].support.near << ','
             << result.modes[m].support.even << ',' << result.unseen << '\n';
  }

  // Until the robot is sure, or ten scans have not sufficed.
  void drives(const Kind& kind, const TestFloor& floor, const simulation::Building& building,
              matching::Localiser& localiser, int seed) {
    for (int i = 0; i < drives_; ++i) {
      const auto way = static_cast<DriveKind>(i % 3);
      const auto number = static_cast<std::uint64_t>(1000 * seed + i);
      auto drive = drive_through(floor, building, way, kind.people, number);
      simulation::Random random(4713, number);
      for (DriveStep& step : drive) step.scan = as_seen(kind, std::move(step.scan), random);
      localiser.forget();
      matching::Localisation result;
      std::size_t step = 0;
      do result = localiser.localise(drive[step].scan, drive[step].T_odom_base);
      while (!result.tracking() && ++step < drive.size());
      const std::size_t last = std::min(step, drive.size() - 1);
      drives_by_kind_[kind.name].add(result, drive[last].truth, kind.foreign);
    }
  }

  // A tracked robot that is carried elsewhere, and is asked two scans later. Its wheels notice
  // nothing.
  void kidnappings(const Kind& kind, const TestFloor& floor, const simulation::Building& building,
                   matching::Localiser& localiser, int seed) {
    if (kind.foreign) return;
    for (int i = 0; i < drives_; ++i) {
      const auto drive_of = [&](int more) {
        const auto number = static_cast<std::uint64_t>(1000 * seed + 500 + 2 * i + more);
        auto drive =
            drive_through(floor, building, static_cast<DriveKind>(i % 3), kind.people, number);
        simulation::Random random(4714, number);
        for (DriveStep& step : drive) step.scan = as_seen(kind, std::move(step.scan), random);
        return drive;
      };
      const auto before = drive_of(0), after = drive_of(1);
      localiser.forget();
      std::size_t step = 0;
      while (step < before.size() &&
             !(localiser.localise(before[step].scan, before[step].T_odom_base).tracking() &&
               step >= 2))
        ++step;
      if (step == before.size()) continue;
      const Pose2 T_odom_odom = before[step].T_odom_base * after[0].T_odom_base.inverse();
      localiser.localise(after[0].scan, T_odom_odom * after[0].T_odom_base);
      const matching::Localisation result =
          localiser.localise(after[1].scan, T_odom_odom * after[1].T_odom_base);
      kidnapped_[kind.name].add(result, after[1].truth, false);
    }
  }

  const int scans_, drives_;
  std::ofstream modes_;
  std::map<std::string, Tally> singles_, drives_by_kind_, kidnapped_;
  Reliability reliability_;
};

void run(Bench& bench, int first_seed, int last_seed) {
  for (int seed = first_seed; seed <= last_seed; ++seed)
    for (const Family& family : kFamilies) bench.floor(family, seed);
}

}  // namespace
}  // namespace voxlist::bench

int main(int argc, char** argv) {
  using namespace voxlist::bench;
  const auto csv = take_csv_option(argc, argv);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  // What ctest passes to all benchmarks: one small run.
  const bool brief = argc > 1 && std::string(argv[1]).starts_with("--");
  const auto argument = [&](int i, int otherwise) {
    return argc > i ? std::atoi(argv[i]) : otherwise;
  };
  Bench bench(brief ? 3 : argument(1, 20), brief ? 1 : argument(2, 10),
              argc > 5 ? argv[5] : nullptr);
  if (brief)
    bench.floor({"small", floor_16_13, 3}, 1);
  else
    run(bench, argument(3, 1), argument(4, argument(3, 1)));
  const auto figures = bench.finish();
  if (csv) append_csv(*csv, "bench_confidence", figures);
}
