// What a hint of where the robot is does to a lost one: how much sooner it is TRACKING by a right
// hint, and whether it ever is at a wrong place by a false one. Arguments, each optional: --csv
// FILE; floor (60x40, 16x13, 200x150, hotel, identical); drives of each case; seed; "false": false
// hints alone. CPU time of one thread.
#include <tbb/global_control.h>

#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/bench/answers.h"
#include "tests/bench/figures.h"
#include "tests/bench/test_drive.h"
#include "tests/bench/test_floor.h"
#include "voxlist/matching/localisation/localiser.h"

namespace voxlist::bench {
namespace {

using matching::Localisation;
using matching::Localiser;

// What voxlist hint says of a place unless it is told otherwise, and how far off people are (m,
// rad), as standard deviations.
constexpr double kSigma_m = 0.5, kSigma_rad = 15.0 * std::numbers::pi / 180.0;
// A hint is false where it is farther away than this (m).
constexpr double kFalse_m = 4.0;

enum class Hint { kNone, kRight, kFalse, kAlike };

UncertainPose about(const Pose2& pose) {
  return {pose, Eigen::Vector3d(kSigma_m * kSigma_m, kSigma_m * kSigma_m, kSigma_rad * kSigma_rad)
                    .asDiagonal()};
}

// What was claimed in drives that end with the first TRACKING.
struct Claims {
  int drives = 0, tracking = 0, wrong = 0, taken = 0;
  std::vector<double> scans, cpu_ms;

  void print(const std::string& name) const {
    std::printf(
        "%-34s %4d drives, TRACKING %4d, wrong %d, hints taken %d; to TRACKING: scans, mean "
        "%.2f, CPU ms, median %.1f, p95 %.1f\n",
        name.c_str(), drives, tracking, wrong, taken, mean(scans), percentile(cpu_ms, 0.5),
        percentile(cpu_ms, 0.95));
    std::fflush(stdout);
  }

  static double mean(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values) sum += value;
    return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
  }
};

class Bench {
 public:
  Bench(const TestFloorConfig& config, int seed)
      : config_(config), seed_(seed), floor_(make_test_floor(config)), localiser_(floor_.map) {}

  // The first scan after a start, when nothing is made ready.
  void starts(int count) const {
    const auto queries = scans_about({}, floor_, floor_.building, count, seed_);
    for (const Hint hint : {Hint::kNone, Hint::kRight}) {
      Claims claims;
      for (const Query& query : queries) {
        Localiser localiser(floor_.map);
        ++claims.drives;
        if (hint == Hint::kRight) claims.taken += localiser.hint(about(query.truth));
        const double start_ms = cpu_ms();
        const Localisation found = localiser.localise(query.scan);
        add({found, query.truth, 1, cpu_ms() - start_ms}, false, claims);
      }
      claims.print(hint == Hint::kNone ? "at the start" : "at the start, right hint");
    }
  }

  void drives(const Kind& kind, Hint hint, const std::string& name, int count) {
    const simulation::Building building = now(kind, config_);
    Claims claims;
    for (int i = 0; i < count; ++i) {
      const auto number = static_cast<std::uint64_t>(1000 * seed_ + i);
      const auto drive =
          drive_through(floor_, building, static_cast<DriveKind>(i % 3), kind.people, number);
      ++claims.drives;
      add(run(drive, hint, number, claims), kind.foreign, claims);
    }
    claims.print(name);
  }

 private:
  struct End {
    Localisation found;
    Pose2 truth;
    int scans;
    double cpu_ms;
  };

  static void add(const End& end, bool foreign, Claims& claims) {
    if (!end.found.tracking()) return;
    ++claims.tracking;
    claims.wrong += right_mode(end.found, end.truth, foreign) != 0;
    claims.scans.push_back(end.scans);
    claims.cpu_ms.push_back(end.cpu_ms);
  }

  End run(const std::vector<DriveStep>& drive, Hint hint, std::uint64_t number, Claims& claims) {
    localiser_.forget();
    if (const auto hinted = place(drive.front(), hint, number))
      claims.taken += localiser_.hint(about(*hinted));
    End end{};
    const double start_ms = cpu_ms();
    for (const DriveStep& step : drive) {
      end.found = localiser_.localise(step.scan, step.T_odom_base);
      end.truth = step.truth;
      ++end.scans;
      if (end.found.tracking()) break;
    }
    end.cpu_ms = cpu_ms() - start_ms;
    return end;
  }

  // The place that is hinted at. Alike: of all places elsewhere the one that fits the scan best.
  std::optional<Pose2> place(const DriveStep& first, Hint hint, std::uint64_t number) {
    simulation::Random random(4719, number);
    if (hint == Hint::kNone) return std::nullopt;
    if (hint == Hint::kRight) {
      const Pose2 off{kSigma_m * random.normal(), kSigma_m * random.normal(),
                      kSigma_rad * random.normal()};
      return Pose2{first.truth.x_m + off.x_m, first.truth.y_m + off.y_m,
                   first.truth.yaw_rad + off.yaw_rad};
    }
    if (hint == Hint::kAlike)
      for (const matching::PoseMode& mode : localiser_.locate(first.scan).modes)
        if (distance_m(mode.T_map_base, first.truth) > kFalse_m) return mode.T_map_base;
    Pose2 elsewhere = first.truth;
    while (distance_m(elsewhere, first.truth) < kFalse_m) elsewhere = free_pose(floor_, random);
    return elsewhere;
  }

  const TestFloorConfig config_;
  const int seed_;
  const TestFloor floor_;
  Localiser localiser_;
};

TestFloorConfig floor_named(const std::string& name, int seed) {
  if (name == "16x13") return floor_16_13(seed);
  if (name == "60x40") return floor_60_40(seed);
  if (name == "200x150") return floor_200_150(seed);
  if (name == "hotel") return hotel_floor(seed);
  if (name == "identical") return identical_floor(seed);
  throw std::invalid_argument("no such floor: " + name);
}

void run(const std::string& name, int count, int seed, bool only_false) {
  Bench bench(floor_named(name, seed), seed);
  std::printf("floor %s, seed %d\n", name.c_str(), seed);
  const Kind mapped{.name = "as mapped"}, changed{.name = "changed", .changed = true, .people = 3},
      foreign{.name = "another building", .foreign = true};
  if (!only_false) bench.starts(3);
  for (const Kind& kind : {mapped, changed}) {
    if (only_false) break;
    bench.drives(kind, Hint::kNone, kind.name, count);
    bench.drives(kind, Hint::kRight, kind.name + ", right hint", count);
  }
  for (const Kind& kind : {mapped, changed, foreign}) {
    bench.drives(kind, Hint::kFalse, kind.name + ", false hint", count);
    bench.drives(kind, Hint::kAlike, kind.name + ", hint at a place alike", count);
  }
}

}  // namespace
}  // namespace voxlist::bench

int main(int argc, char** argv) {
  using namespace voxlist::bench;
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  // What ctest passes: one small run.
  const bool brief = argc > 1 && std::string(argv[1]).starts_with("--");
  const auto argument = [&](int i, const char* otherwise) {
    return argc > i ? argv[i] : otherwise;
  };
  if (brief)
    run("16x13", 2, 1, false);
  else
    run(argument(1, "60x40"), std::atoi(argument(2, "30")), std::atoi(argument(3, "1")),
        std::string(argument(4, "")) == "false");
}
