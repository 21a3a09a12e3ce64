// What people leave in a map, and what carving takes of it that stands there: by our rule, by
// OctoMap's balance of hits and passes, and by DUFOMap's rule, on the same scans in one run.
// Arguments: [--seeds FIRST LAST] [--csv FILE]; without seeds: seed 1 and the 16-ring laser alone.
#include <cstdio>
#include <exception>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "tests/bench/figures.h"
#include "tests/bench/ghosts/ghost_drive.h"
#include "voxlist/simulation/random.h"
#include "voxlist/voxels/counters/counter_map.h"
#include "voxlist/voxels/voids/carved_map.h"

namespace voxlist::bench {
namespace {

constexpr double kVoxel_m = kFinestResolution_m, kCell_m = 0.08, kDufomap_m = 0.1;
constexpr std::int32_t kVoxelsInCell = 4, kVoxelsInDufomap = 5;
constexpr unsigned kLooks = 3;
// What poses are off by, each coordinate's standard deviation.
constexpr double kOff_m = 0.01, kOff_rad = 0.001;

// What was hit in a voxel, by any scan.
struct Truth {
  bool is_static = false, is_thin = false, now = false, before = false;
};

// In how many scans of the second day a cell's ray ended on something new, or would have ended on
// something that was moved.
struct Looks {
  unsigned at_new = 0, at_moved = 0;
};

struct Scene {
  std::vector<GhostScan> scans;
  std::vector<Pose3> poses;  // as the map believes
  Numbering<Voxel> voxels, cells;
  std::vector<Truth> truth;
  std::vector<Looks> looks;
};

template <class T>
T& at(Numbering<Voxel>& numbers, std::vector<T>& values, const Voxel& key) {
  const std::uint32_t number = numbers.number(key);
  if (number == values.size()) values.emplace_back();
  return values[number];
}

Voxel larger(const Voxel& v, std::int32_t factor) {
  return {floor_div(v.x, factor), floor_div(v.y, factor), floor_div(v.z, factor)};
}

void note_hits(const GhostScan& scan, const Pose3& pose, Scene& scene) {
  Numbering<Voxel> at_new;
  for (std::size_t i = 0; i < scan.cloud.points.size(); ++i) {
    const Eigen::Vector3d p = pose * scan.cloud.points[i].cast<double>();
    Truth& truth = at(scene.voxels, scene.truth, voxel_at(p, kVoxel_m));
    truth.is_static |= scan.met[i] == Met::kStatic || scan.met[i] == Met::kThin;
    truth.is_thin |= scan.met[i] == Met::kThin;
    if (scan.met[i] != Met::kMoved) continue;
    (scan.lap == 0 ? truth.before : truth.now) = true;
    if (scan.lap > 0) at_new.number(voxel_at(p, kCell_m));
  }
  for (const Voxel& cell : at_new.keys()) ++at(scene.cells, scene.looks, cell).at_new;
}

void note_missed(const GhostScan& scan, const Pose3& pose, Scene& scene) {
  Numbering<Voxel> missed;
  for (const Eigen::Vector3f& p : scan.missed)
    missed.number(voxel_at(Eigen::Vector3d(pose * p.cast<double>()), kCell_m));
  for (const Voxel& cell : missed.keys()) ++at(scene.cells, scene.looks, cell).at_moved;
}

Scene make_scene(const GhostDriveConfig& config, bool is_off) {
  Scene scene;
  scene.scans = ghost_drive(config);
  simulation::Random random(static_cast<std::uint64_t>(config.seed), 8);
  for (const GhostScan& scan : scene.scans) {
    Pose2 pose = scan.truth;
    if (is_off) {
      pose.x_m += kOff_m * random.normal();
      pose.y_m += kOff_m * random.normal();
      pose.yaw_rad += kOff_rad * random.normal();
    }
    scene.poses.push_back(to_pose3(pose));
    note_hits(scan, scene.poses.back(), scene);
    note_missed(scan, scene.poses.back(), scene);
  }
  return scene;
}

struct Share {
  std::size_t part = 0, of = 0;

  void count(bool is_part) { ++of, part += is_part; }
  double percent() const {
    return of == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(of);
  }
};

struct Result {
  Share left, kept, thin_kept, moved_gone, new_there, moved_right;
  double ms = 0.0;
  int scans = 0;
};

template <class IsThere>
void count(const Scene& scene, const IsThere& is_there, Result& r) {
  for (std::size_t i = 0; i < scene.truth.size(); ++i) {
    const Voxel& voxel = scene.voxels.key(i);
    const Truth& truth = scene.truth[i];
    const bool there = is_there(voxel);
    if (there) r.left.count(!truth.is_static && !truth.now && !truth.before);
    if (truth.is_static) r.kept.count(there);
    if (truth.is_thin) r.thin_kept.count(there);
    const std::uint32_t cell = scene.cells.find(larger(voxel, kVoxelsInCell));
    if (truth.is_static || cell == Numbering<Voxel>::kNone) continue;
    const Looks& looks = scene.looks[cell];
    const bool is_new = truth.now && looks.at_new >= kLooks;
    const bool is_gone = truth.before && !truth.now && looks.at_moved >= kLooks;
    if (is_new) r.new_there.count(there), r.moved_right.count(there);
    if (is_gone) r.moved_gone.count(!there), r.moved_right.count(!there);
  }
}

// Calls add(scan, pose) for each scan, and takes the time.
template <class Add>
void add_all(const Scene& scene, const Add& add, Result& result) {
  const double start_ms = cpu_ms();
  for (std::size_t i = 0; i < scene.scans.size(); ++i) add(scene.scans[i].cloud, scene.poses[i]);
  result.ms += cpu_ms() - start_ms;
  result.scans += static_cast<int>(scene.scans.size());
}

void by_balance(const Scene& scene, Result& result) {
  RayRules rules;
  rules.resolution_m = kVoxel_m;
  rules.most_blocks = std::size_t{1} << 22;
  CounterMap counters(kVoxel_m);
  RayScratch scratch(rules);
  const auto add = [&](const Cloud& cloud, const Pose3& pose) {
    scratch.mark(pose, cloud);
    counters.add(scratch);
  };
  add_all(scene, add, result);
  count(
      scene, [&](const Voxel& v) { return counters.at(v) == CellState::kOccupied; }, result);
}

// All 27 cells about a cell are free in one scan: it is void for good.
void by_dufomap(const Scene& scene, Result& result) {
  MarkedScan marks(RayRules().min_range_m, RayRules().max_range_m, kDufomap_m);
  VoidScan scan({kDufomap_m, 27});
  VoxelMap is_void(kDufomap_m);
  const auto add = [&](const Cloud& cloud, const Pose3& pose) {
    marks.mark(pose, cloud);
    scan.take(marks);
    for (const VoidScan::Block& block : scan.blocks())
      is_void.merge_block(block.at, in_rows(CellStore::Block(block.is_void)));
  };
  add_all(scene, add, result);
  count(
      scene, [&](const Voxel& v) { return !is_void.contains(larger(v, kVoxelsInDufomap)); },
      result);
}

void by_carving(const Scene& scene, bool carve, Result& result) {
  CarvedMap map({.carve = carve});
  const auto add = [&](const Cloud& cloud, const Pose3& pose) { map.add({pose, cloud}); };
  add_all(scene, add, result);
  count(
      scene, [&](const Voxel& v) { return map.map().occupied.contains(v); }, result);
}

using Results = std::map<std::string, Result>;

// The scene; none, and a line, where furniture stands before a door.
std::optional<Scene> scene_of(const GhostDriveConfig& config, bool is_off) try {
  return make_scene(config, is_off);
} catch (const std::runtime_error& error) {
  std::printf("seed %d is left out: %s\n", config.seed, error.what());
  return std::nullopt;
}

void measure(const Scene& scene, Results& results) {
  by_carving(scene, false, results["nothing goes"]);
  by_balance(scene, results["OctoMap's balance, 0.02 m"]);
  by_dufomap(scene, results["DUFOMap's rule, 0.1 m"]);
  by_carving(scene, true, results["voids"]);
}

std::vector<Figure> figures_of(const std::string& scene, const std::string& rule, const Result& r) {
  return {{scene, rule, "left_percent", r.left.percent()},
          {scene, rule, "static_kept_percent", r.kept.percent()},
          {scene, rule, "thin_kept_percent", r.thin_kept.percent()},
          {scene, rule, "moved_gone_percent", r.moved_gone.percent()},
          {scene, rule, "new_there_percent", r.new_there.percent()},
          {scene, rule, "moved_right_percent", r.moved_right.percent()},
          {scene, rule, "ms_a_scan", r.ms / r.scans}};
}

void tell(const std::string& scene, const Results& results, const std::optional<std::string>& csv) {
  std::printf("%s\n", scene.c_str());
  for (const auto& [rule, r] : results) {
    std::printf(
        "  %-26s left %.3f %%, static kept %.3f %% (thin %.2f), moved right %.2f %% (gone "
        "%.2f, new %.2f), %.2f ms\n",
        rule.c_str(), r.left.percent(), r.kept.percent(), r.thin_kept.percent(),
        r.moved_right.percent(), r.moved_gone.percent(), r.new_there.percent(), r.ms / r.scans);
    if (csv) append_csv(*csv, "bench_ghosts", figures_of(scene, rule, r));
  }
  std::fflush(stdout);
}

struct Options {
  int first = 1, last = 1;
  bool is_quick = true;
};

Options options_of(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  for (std::size_t i = 0; i + 2 < arguments.size(); ++i)
    if (arguments[i] == "--seeds")
      return {std::stoi(arguments[i + 1]), std::stoi(arguments[i + 2]), false};
  return {};
}

int run(int argc, char** argv) {
  const auto csv = take_csv_option(argc, argv);
  const Options options = options_of(argc, argv);
  const std::pair<GhostLaser, std::string> lasers[] = {{GhostLaser::k16Rings, "16 rings"},
                                                       {GhostLaser::kMirror, "mirror scanner"},
                                                       {GhostLaser::k64Rings, "64 rings"}};
  for (const auto& [laser, name] : lasers) {
    for (const bool is_off : {false, true}) {
      Results results;
      for (int seed = options.first; seed <= options.last; ++seed)
        if (const auto scene = scene_of({laser, seed}, is_off)) measure(*scene, results);
      tell(name + (is_off ? ", poses off" : ", true poses"), results, csv);
      if (options.is_quick) return 0;
    }
  }
  return 0;
}

}  // namespace
}  // namespace voxlist::bench

int main(int argc, char** argv) {
  try {
    return voxlist::bench::run(argc, argv);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "bench_ghosts: %s\n", e.what());
    return 1;
  }
}
