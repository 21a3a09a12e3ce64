// Loops of drives through offices of which none can be told from another, whose wheels drift: how
// many are believed, how many of them are wrong, and where keyframes stand then. Arguments, each
// optional: --csv FILE; first seed; last seed; offices (12). CPU time of one thread.
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "tests/bench/drives/twin_drive.h"
#include "tests/bench/figures.h"
#include "tests/simulation/sphere_scan.h"
#include "voxlist/mapping/graph/loop_closing.h"
#include "voxlist/mapping/loops/loop_search.h"
#include "voxlist/mapping/loops/neighbours.h"
#include "voxlist/simulation/random.h"

namespace voxlist::bench {
namespace {

using mapping::Loop;

// A loop is wrong from here on (m, rad): an office is 4 m wide.
constexpr double kWrong_m = 0.3, kWrong_rad = 0.05;

bool is_right(const Loop& loop, const std::vector<Pose2>& truth) {
  const Pose2 seen = truth[loop.edge.from].inverse() * truth[loop.edge.to];
  const Pose2& told = loop.edge.T_from_to.pose;
  return distance_m(seen, told) < kWrong_m && turn_rad(seen, told) < kWrong_rad;
}

// Where the first is right.
double rmse_m(const std::vector<Pose2>& poses, const std::vector<Pose2>& truth) {
  double squares = 0.0;
  for (std::size_t i = 0; i < poses.size(); ++i)
    squares += std::pow(distance_m(poses[i], truth[i]), 2.0);
  return std::sqrt(squares / static_cast<double>(poses.size()));
}

mapping::DriveOdometry odometry_of(const TwinDrive& drive) {
  return {drive.T_odom_base.begin(), drive.T_odom_base.end()};
}

mapping::ReadCloud scans_of(const simulation::World& world, const TwinDrive& drive) {
  return [&](std::size_t i) {
    if (drive.blind.contains(i)) return Cloud{};
    return simulation::scan_sphere(world, drive.truth[i], {.rays = 8000, .range_max_m = 15.0}, i);
  };
}

// Ten groups of three wrong loops that agree with each other, of looks of their own: half of them
// where the drive may well have been, the others up to 20 m off.
std::vector<Loop> with_forged(std::vector<Loop> loops, const std::vector<Pose2>& truth, int seed) {
  simulation::Random random(static_cast<std::uint64_t>(seed), 31);
  const Loop real = loops.front();
  const double half = static_cast<double>(truth.size()) / 2.0;
  for (std::size_t group = 0; group < 10; ++group) {
    const auto from = static_cast<std::size_t>(random.uniform(0.0, half - 4.0));
    const auto to = static_cast<std::size_t>(random.uniform(half, 2.0 * half - 4.0));
    const double far_m = group % 2 == 0 ? 1.0 : 20.0;
    const Pose2 off{random.uniform(0.5, far_m), random.uniform(0.5, far_m), 0.0};
    for (std::size_t i = 0; i < 3; ++i) {
      Loop& forged = loops.emplace_back(real);
      forged.edge.from = from + i;
      forged.edge.to = to + i;
      forged.edge.T_from_to.pose = (off * truth[from + i]).inverse() * truth[to + i];
      forged.look = 1'000'000 + 3 * group + i;
      forged.probability = 1.0;
    }
  }
  return loops;
}

std::vector<Figure> run(int rooms, int seed, bool blind) {
  const simulation::Building building = twin_offices(rooms, seed);
  const simulation::World world(building);
  const TwinDrive drive = twin_drive(building, blind, seed);
  const mapping::ReadCloud read = scans_of(world, drive);
  const double start_ms = cpu_ms();
  const auto steps = mapping::join_neighbours(drive.T_odom_base, odometry_of(drive), read, {});
  const mapping::PoseTree tree(drive.truth.size(), steps);
  std::vector<Loop> loops = mapping::find_loops(tree, read, {});
  const Pose2 first = drive.truth.front();
  const mapping::ClosedDrive open = close_loops(tree, steps, {}, first);
  const mapping::ClosedDrive closed = close_loops(tree, steps, loops, first);
  const double took_ms = cpu_ms() - start_ms;
  const mapping::ClosedDrive forged =
      loops.empty() ? closed
                    : close_loops(tree, steps, with_forged(loops, drive.truth, seed), first);
  const auto right = std::count_if(closed.loops.begin(), closed.loops.end(),
                                   [&](const Loop& loop) { return is_right(loop, drive.truth); });
  const std::size_t looks = loops.size();
  std::erase_if(loops, [&](const Loop& loop) { return !is_right(loop, drive.truth); });
  const std::string scene = "offices, seed " + std::to_string(seed) + (blind ? ", blind 8 m" : "");
  const auto figure = [&](const char* measure, double value) {
    return Figure{scene, "loops", measure, value};
  };
  std::vector<Figure> figures{
      figure("keyframes", static_cast<double>(drive.truth.size())),
      figure("places_named", static_cast<double>(looks)),
      figure("places_named_right", static_cast<double>(loops.size())),
      figure("loops", static_cast<double>(closed.loops.size())),
      figure("wrong_loops", static_cast<double>(closed.loops.size()) - static_cast<double>(right)),
      figure("wrong_loops_with_30_forged",
             static_cast<double>(
                 std::count_if(forged.loops.begin(), forged.loops.end(),
                               [&](const Loop& loop) { return !is_right(loop, drive.truth); }))),
      figure("rmse_with_30_forged_m", rmse_m(forged.poses, drive.truth)),
      figure("rmse_by_wheels_m", rmse_m(drive.T_odom_base, drive.truth)),
      figure("rmse_without_loops_m", rmse_m(open.poses, drive.truth)),
      figure("rmse_m", rmse_m(closed.poses, drive.truth)),
      figure("rmse_by_right_loops_m",
             rmse_m(close_loops(tree, steps, loops, first).poses, drive.truth)),
      figure("cpu_s", took_ms / 1000.0)};
  print(scene, figures);
  return figures;
}

}  // namespace
}  // namespace voxlist::bench

int main(int argc, char** argv) {
  using namespace voxlist::bench;
  const auto csv = take_csv_option(argc, argv);
  // What ctest passes to all benchmarks: one small run.
  const bool brief = argc > 1 && std::string(argv[1]).starts_with("--");
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const auto argument = [&](int i, int usual) {
    return !brief && argc > i ? std::atoi(argv[i]) : usual;
  };
  const int first = argument(1, 1), last = argument(2, first);
  std::vector<Figure> figures;
  for (int seed = first; seed <= last; ++seed) {
    for (const bool blind : {false, true}) {
      const auto measured = run(brief ? 2 : argument(3, 12), seed, blind);
      figures.insert(figures.end(), measured.begin(), measured.end());
    }
  }
  if (csv) append_csv(*csv, "bench_loops", figures);
}
