// What a crowd leaves in the map of a robot that drives about among them: against the map of the
// same drive through the same building without anybody.
// Arguments: [--minutes N] [--seeds FIRST LAST] [--csv FILE]; without: seed 1, a floor of 16 x 13 m
// and two minutes; with minutes: 60 x 40 m.
#include <cstdio>
#include <exception>
#include <optional>
#include <string>
#include <vector>

#include "tests/bench/figures.h"
#include "tests/bench/ghosts/ghost_drive.h"
#include "voxlist/simulation/scanner/ideal_sweep.h"
#include "voxlist/voxels/voids/carved_map.h"

namespace voxlist::bench {
namespace {

using simulation::Building;
using simulation::Trajectory;

struct Options {
  int minutes = 2, first = 1, last = 1;
  bool is_quick = true;
};

// Lap after lap, for so long.
Trajectory laps(const Building& building, double duration_s) {
  const Trajectory once = lap(building);
  std::vector<Pose2> poses;
  while (once.period_s() * static_cast<double>(poses.size()) < duration_s)
    poses.insert(poses.end(), once.poses().begin(), once.poses().end());
  return {once.period_s(), std::move(poses)};
}

class Drive {
 public:
  Drive(const Options& options, int seed)
      : seed_(static_cast<std::uint64_t>(seed)),
        duration_s_(60.0 * options.minutes),
        building_(building_of(options, seed)),
        way_(laps(building_, duration_s_)) {}

  // The maps, carved and not, after a drive among so many people.
  std::pair<VoxelMap, VoxelMap> maps(int people) const {
    const simulation::World world(
        building_, simulation::walk(building_, way_, duration_s_, {people, 1.0}, seed_));
    const simulation::MirrorScanner scanner(world, way_, {}, seed_);
    CarvedMap carved({.carve = true}), whole({.carve = false});
    for (double t = 1.0; t < duration_s_; t += 1.0) {
      const Cloud cloud = simulation::scan_sweep(scanner, way_, t, {}, seed_);
      const Pose3 pose = to_pose3(way_.at(t));
      carved.add({pose, cloud});
      whole.add({pose, cloud});
    }
    return {carved.map().occupied, whole.map().occupied};
  }

  double length_m() const { return 0.5 * duration_s_; }

 private:
  static Building building_of(const Options& options, int seed) {
    simulation::BuildingConfig config;
    config.seed = seed;
    if (!options.is_quick) config.length_m = 60.0, config.depth_m = 40.0, config.rooms = 12;
    return simulation::make_building(config);
  }

  const std::uint64_t seed_;
  const double duration_s_;
  const Building building_;
  const Trajectory way_;
};

bool is_near(const Voxel& v, const VoxelMap& map) {
  for (std::int32_t x = -1; x <= 1; ++x)
    for (std::int32_t y = -1; y <= 1; ++y)
      for (std::int32_t z = -1; z <= 1; ++z)
        if (map.contains({v.x + x, v.y + y, v.z + z})) return true;
  return false;
}

// The share of a map's voxels with none of the other map's within a voxel of them.
double percent_beyond(const VoxelMap& map, const VoxelMap& other) {
  std::size_t beyond = 0;
  map.for_each_voxel([&](const Voxel& v) { beyond += !is_near(v, other); });
  return 100.0 * static_cast<double>(beyond) / static_cast<double>(map.size());
}

void tell(int seed, const std::string& rule, const VoxelMap& crowd, const VoxelMap& empty,
          const std::optional<std::string>& csv) {
  const double more = percent_beyond(crowd, empty), less = percent_beyond(empty, crowd);
  std::printf("seed %d, %-14s %zu voxels, %zu without people: %.3f %% more, %.3f %% missing\n",
              seed, rule.c_str(), crowd.size(), empty.size(), more, less);
  std::fflush(stdout);
  if (!csv) return;
  const std::string scene = "seed " + std::to_string(seed);
  append_csv(*csv, "bench_crowd",
             {{scene, rule, "more_percent", more}, {scene, rule, "missing_percent", less}});
}

Options options_of(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  Options options;
  for (std::size_t i = 0; i + 1 < arguments.size(); ++i) {
    if (arguments[i] == "--minutes") {
      options.minutes = std::stoi(arguments[i + 1]);
      options.is_quick = false;
    }
    if (arguments[i] == "--seeds" && i + 2 < arguments.size()) {
      options.first = std::stoi(arguments[i + 1]);
      options.last = std::stoi(arguments[i + 2]);
    }
  }
  return options;
}

int run(int argc, char** argv) {
  const auto csv = take_csv_option(argc, argv);
  const Options options = options_of(argc, argv);
  for (int seed = options.first; seed <= options.last; ++seed) {
    const Drive drive(options, seed);
    const auto [carved, whole] = drive.maps(options.is_quick ? 4 : 20);
    const auto [carved_empty, whole_empty] = drive.maps(0);
    tell(seed, "carved:", carved, carved_empty, csv);
    tell(seed, "nothing goes:", whole, whole_empty, csv);
  }
  return 0;
}

}  // namespace
}  // namespace voxlist::bench

int main(int argc, char** argv) {
  try {
    return voxlist::bench::run(argc, argv);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "bench_crowd: %s\n", e.what());
    return 1;
  }
}
