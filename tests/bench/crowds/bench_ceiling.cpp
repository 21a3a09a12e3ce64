// Single scans from the midst of a crowd, located in whole simulated floors without a guess, by a
// localiser that matches all heights and by one that matches what is above people's heads.
// Arguments: --csv FILE; queries for each case (50), first seed (1), last seed, people in sight
// (30).
#include <tbb/global_control.h>

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string>
#include <vector>

#include "tests/bench/answers.h"
#include "tests/bench/figures.h"
#include "tests/bench/test_floor.h"
#include "voxlist/matching/localisation/localiser.h"
#include "voxlist/simulation/scanner/ideal_sweep.h"

namespace voxlist::bench {
namespace {

// Above the heads of people of 1.75 m, and up to any ceiling.
const std::vector<double> kAboveHeads_m{1.9, 4.0};

// People stand so far from the robot and from each other (m), where they have room.
constexpr double kNearest_m = 0.8, kFarthest_m = 8.0, kApart_m = 0.5, kRoom_m = 0.25;
// Their eyes (m): those in sight can look at the scanner.
constexpr double kEyes_m = 1.6, kScanner_m = 1.2;
constexpr int kTries = 1000;

using People = std::vector<simulation::Trajectory>;

bool sees(const simulation::Building& building, const Pose2& from, const Pose2& to) {
  const Eigen::Vector3d eye(from.x_m, from.y_m, kScanner_m), end(to.x_m, to.y_m, kEyes_m);
  const double far_m = (end - eye).norm();
  return building.solid.range(eye, (end - eye) / far_m).value_or(far_m) >= far_m;
}

// As many as asked for, all in sight; fewer where the place is too small.
std::vector<Pose2> crowd_round(const simulation::Building& building, const Pose2& robot,
                               std::size_t people, simulation::Random& random) {
  std::vector<Pose2> crowd;
  for (int i = 0; i < kTries && crowd.size() < people; ++i) {
    const double bearing = random.uniform(-std::numbers::pi, std::numbers::pi),
                 range_m = random.uniform(kNearest_m, kFarthest_m);
    const Pose2 spot{robot.x_m + range_m * std::cos(bearing),
                     robot.y_m + range_m * std::sin(bearing),
                     random.uniform(-std::numbers::pi, std::numbers::pi)};
    const bool is_apart =
        std::ranges::none_of(crowd, [&](const Pose2& p) { return distance_m(p, spot) < kApart_m; });
    if (is_apart && sees(building, robot, spot) &&
        building.clearance_m({spot.x_m, spot.y_m}, 0.05, 1.8) > kRoom_m)
      crowd.push_back(spot);
  }
  return crowd;
}

Cloud scan_amidst(const simulation::Building& building, const std::vector<Pose2>& crowd,
                  const Pose2& robot, bool sees_all_round, std::uint64_t seed) {
  People people;
  for (const Pose2& person : crowd) people.emplace_back(1.0, std::vector<Pose2>{person});
  const simulation::World world(building, std::move(people));
  if (sees_all_round) return scan_sphere(world, robot, {}, seed);
  const simulation::Trajectory still(1.0, {robot});
  return scan_sweep(simulation::MirrorScanner(world, still, {}, seed), still, 1.0, {}, seed);
}

// What each localiser said.
struct Answers {
  Tally all_heights, above_heads;
};

class Bench {
 public:
  Bench(int queries, std::size_t people) : queries_(queries), people_(people) {}

  std::vector<Figure> floor(const TestFloorConfig& config, int seed) const {
    const TestFloor floor = make_test_floor(config);
    matching::LocaliserConfig above_heads;
    above_heads.matcher.scan.match_heights_m = kAboveHeads_m;
    matching::Localiser all(floor.map), above(floor.map, above_heads);
    std::vector<Figure> figures;
    for (const Kind& test : {Kind{"as mapped", false, false}, Kind{"changed", true, false},
                             Kind{"another building", false, true}}) {
      const Answers answers = ask(floor, test, seed, all, above);
      tell(floor.name + ", " + test.name + ", all heights", answers.all_heights, figures);
      tell(floor.name + ", " + test.name + ", above heads", answers.above_heads, figures);
    }
    return figures;
  }

 private:
  // Only where the whole crowd is in sight.
  Answers ask(const TestFloor& floor, const Kind& test, int seed, matching::Localiser& all,
              matching::Localiser& above) const {
    const simulation::Building building = now(test, floor.config);
    simulation::Random random(4714, static_cast<std::uint64_t>(seed));
    Answers answers;
    while (answers.all_heights.asked < queries_) {
      const Pose2 truth = free_pose(floor, random);
      if (building.clearance_m({truth.x_m, truth.y_m}, 0.05, 1.0) < 0.35) continue;
      const std::vector<Pose2> crowd = crowd_round(building, truth, people_, random);
      if (crowd.size() < people_) continue;
      const Cloud scan = scan_amidst(building, crowd, truth, floor.config.map_of_spheres,
                                     static_cast<std::uint64_t>(answers.all_heights.asked));
      answers.all_heights.add(all.locate(scan), truth, test.foreign);
      answers.above_heads.add(above.locate(scan), truth, test.foreign);
    }
    return answers;
  }

  static void tell(const std::string& name, const Tally& tally, std::vector<Figure>& figures) {
    tally.print(name);
    figures.push_back({name, "single scans in a crowd", "first_right", double(tally.first_right)});
    figures.push_back(
        {name, "single scans in a crowd", "tracking_right", double(tally.tracking_right)});
    figures.push_back(
        {name, "single scans in a crowd", "tracking_wrong", double(tally.tracking_wrong)});
  }

  const int queries_;
  const std::size_t people_;
};

}  // namespace
}  // namespace voxlist::bench

int main(int argc, char** argv) {
  using namespace voxlist::bench;
  const auto csv = take_csv_option(argc, argv);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  // What ctest passes to all benchmarks: one small run.
  const bool brief = argc > 1 && std::string(argv[1]).starts_with("--");
  const auto argument = [&](int i, int otherwise) {
    return argc > i && !brief ? std::atoi(argv[i]) : otherwise;
  };
  const Bench bench(argument(1, brief ? 2 : 50),
                    static_cast<std::size_t>(argument(4, brief ? 5 : 30)));
  std::vector<Figure> figures;
  const auto add = [&](const TestFloorConfig& config, int seed) {
    const auto more = bench.floor(config, seed);
    figures.insert(figures.end(), more.begin(), more.end());
  };
  const int first = argument(2, 1), last = argument(3, first);
  for (int seed = first; seed <= last; ++seed) {
    add(brief ? floor_16_13(seed) : floor_60_40(seed), seed);
    if (!brief) add(floor_40_25(seed), seed);
  }
  if (csv) append_csv(*csv, "bench_ceiling", figures);
}
