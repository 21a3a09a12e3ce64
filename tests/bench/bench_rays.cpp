// Free and occupied space by OctoMap's own insertPointCloud and by counters, on the same scans in
// one run on one thread: how long each takes a scan, and how far they agree.
// Arguments: SCANS_DIR POSES RESOLUTION_M [--csv FILE]; or for a simulated floor how many scans
// (12).
#include <octomap/OcTree.h>

#include <bit>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "tests/bench/figures.h"
#include "tests/bench/test_floor.h"
#include "voxlist/geometry/range.h"
#include "voxlist/io/scans/scan_folder.h"
#include "voxlist/voxels/counters/counter_map.h"

namespace voxlist::bench {
namespace {

constexpr double kSphereRange_m = 8.0, kAnyRange_m = 100.0;
constexpr std::uint64_t kSpheres = 12;
constexpr int kSeed = 14;

struct Scan {
  Pose3 T_map_base;
  Cloud cloud;
};

// OctoMap's insertPointCloud knows one origin for all rays: that of the first.
Scan from_one_place(Scan scan, double max_range_m) {
  Cloud kept;
  for (std::size_t i = 0; i < scan.cloud.points.size(); ++i) {
    const Eigen::Vector3f origin = scan.cloud.origin(0);
    const Cloud one{0, {scan.cloud.points[i]}, {origin}};
    if (!is_within(one, 0, RayRules().min_range_m, max_range_m)) continue;
    kept.points.push_back(scan.cloud.points[i]);
    kept.origins.push_back(origin);
  }
  scan.cloud = std::move(kept);
  return scan;
}

std::vector<Scan> recorded(const std::filesystem::path& folder, const std::string& poses) {
  const io::ScanFolder scans(folder);
  const io::PoseTable table = io::read_poses(poses);
  const io::RowMatch match = scans.match(table);
  std::vector<Scan> all;
  for (std::size_t i = 0; i < scans.size(); ++i)
    if (match.rows[i])
      all.push_back(from_one_place({table.rows[*match.rows[i]].pose, scans.read(i)}, kAnyRange_m));
  return all;
}

std::vector<Scan> simulated(std::uint64_t spheres) {
  const TestFloorConfig config = floor_16_13(kSeed);
  const TestFloor floor{config.name, config,      simulation::make_floor(config.wing, config.wings),
                        {0.0, -6.0}, {15.0, 6.0}, {}};
  simulation::Random random(kSeed);
  std::vector<Scan> all;
  for (std::uint64_t i = 0; i < spheres; ++i) {
    const Pose2 pose = free_pose(floor, random);
    all.push_back(from_one_place(
        {to_pose3(pose), sphere_scan_at(floor.building, pose, 64'000, 0, i)}, kSphereRange_m));
  }
  return all;
}

class OctomapsOwn {
 public:
  explicit OctomapsOwn(double resolution_m) : tree_(resolution_m) {}

  void add(const Scan& scan) {
    const auto point = [&](const Eigen::Vector3f& p) {
      const Eigen::Vector3f q = (scan.T_map_base * p.cast<double>()).cast<float>();
      return octomap::point3d(q.x(), q.y(), q.z());
    };
    octomap::Pointcloud points;
    for (const Eigen::Vector3f& p : scan.cloud.points) points.push_back(point(p));
    const double start_ms = cpu_ms();
    tree_.insertPointCloud(points, point(scan.cloud.origin(0)), -1.0, true);
    ms += cpu_ms() - start_ms;
  }

  // As a map of cells.
  octomap::OcTree& finished() {
    tree_.updateInnerOccupancy();
    tree_.expand();
    return tree_;
  }

  double ms = 0.0;

 private:
  octomap::OcTree tree_;
};

RayRules rules(double resolution_m, bool every_ray) {
  RayRules rules;
  rules.resolution_m = resolution_m;
  rules.every_ray = every_ray;
  rules.most_blocks = std::size_t{1} << 22;
  return rules;
}

struct Ours {
  Ours(double resolution_m, bool every_ray)
      : scratch(rules(resolution_m, every_ray)), map(resolution_m) {}

  void add(const Scan& scan) {
    const double start_ms = cpu_ms();
    scratch.mark(scan.T_map_base, scan.cloud);
    marking_ms += cpu_ms() - start_ms;
    map.add(scratch);
    map.take_changed();
    ms += cpu_ms() - start_ms;
  }

  RayScratch scratch;
  CounterMap map;
  double ms = 0.0, marking_ms = 0.0;
};

std::size_t known_cells(const CounterMap& map) {
  std::size_t known = 0;
  for (std::size_t i = 0; i < map.block_count(); ++i)
    for (const std::uint64_t word : map.known(i))
      known += static_cast<std::size_t>(std::popcount(word));
  return known;
}

// Of all cells that either knows, the share that is the same to both.
double alike(octomap::OcTree& tree, const CounterMap& map) {
  std::size_t same = 0, both = 0, theirs = 0;
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    const octomap::OcTreeKey key = leaf.getKey();
    const CellState state = map.at({key[0] - kReach, key[1] - kReach, key[2] - kReach});
    ++theirs;
    both += state != CellState::kUnknown;
    same += state == (tree.isNodeOccupied(*leaf) ? CellState::kOccupied : CellState::kFree);
  }
  const std::size_t all = theirs + known_cells(map) - both;
  return static_cast<double>(same) / static_cast<double>(all);
}

struct Row {
  double resolution_m, octomap_ms, every_ray_ms, ms, alike;
};

void append(const std::string& file, const Row& row) {
  const bool is_new = !std::filesystem::exists(file);
  std::ofstream out(file, std::ios::app);
  if (is_new) out << "resolution_m,octomap_ms,every_ray_ms,ms,ratio,alike\n";
  out << row.resolution_m << ',' << row.octomap_ms << ',' << row.every_ray_ms << ',' << row.ms
      << ',' << row.octomap_ms / row.ms << ',' << row.alike << '\n';
  if (!out.flush()) throw std::runtime_error("cannot write " + file);
}

Row compare(const std::vector<Scan>& scans, double resolution_m) {
  OctomapsOwn octomap(resolution_m);
  Ours every(resolution_m, true), one(resolution_m, false);
  // OctoMap last: it leaves millions of small pieces of freed memory, which whoever asks for memory
  // next has to put together.
  for (const Scan& scan : scans) every.add(scan);
  for (const Scan& scan : scans) one.add(scan);
  for (const Scan& scan : scans) octomap.add(scan);
  const auto count = static_cast<double>(scans.size());
  octomap::OcTree& tree = octomap.finished();
  const Row row{resolution_m, octomap.ms / count, every.ms / count, one.ms / count,
                alike(tree, one.map)};
  const double blocks = static_cast<double>(one.map.block_count());
  std::printf("%.2f m: OctoMap %.1f ms a scan\n", resolution_m, row.octomap_ms);
  std::printf("  every ray             %7.3f ms (%.3f of it marking), %6.1f x, %.3f %% alike\n",
              row.every_ray_ms, every.marking_ms / count, row.octomap_ms / row.every_ray_ms,
              100.0 * alike(tree, every.map));
  std::printf("  one ray a hit voxel   %7.3f ms (%.3f of it marking), %6.1f x, %.3f %% alike\n",
              row.ms, one.marking_ms / count, row.octomap_ms / row.ms, 100.0 * row.alike);
  std::printf("  %.3f bytes a voxel of %.0f blocks\n",
              static_cast<double>(one.map.memory_bytes()) / (512.0 * blocks), blocks);
  return row;
}

// Options of other programs are passed over.
std::vector<std::string> arguments_of(int argc, char** argv) {
  std::vector<std::string> arguments(argv + 1, argv + argc);
  std::erase_if(arguments, [](const std::string& a) { return a.starts_with("--"); });
  return arguments;
}

int run(int argc, char** argv) {
  const auto csv = take_csv_option(argc, argv);
  const std::vector<std::string> arguments = arguments_of(argc, argv);
  const bool has_scans = arguments.size() == 3;
  const std::uint64_t spheres = arguments.size() == 1 ? std::stoull(arguments[0]) : kSpheres;
  std::vector<double> resolutions_m{0.1, 0.05};
  if (has_scans) resolutions_m = {std::stod(arguments[2])};
  const std::vector<Scan> scans =
      has_scans ? recorded(arguments[0], arguments[1]) : simulated(spheres);
  if (scans.empty()) throw std::runtime_error("no scan has a pose");
  for (const double resolution_m : resolutions_m) {
    const Row row = compare(scans, resolution_m);
    if (csv) append(*csv, row);
  }
  return 0;
}

}  // namespace
}  // namespace voxlist::bench

int main(int argc, char** argv) {
  try {
    return voxlist::bench::run(argc, argv);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "bench_rays: %s\n", e.what());
    return 1;
  }
}
