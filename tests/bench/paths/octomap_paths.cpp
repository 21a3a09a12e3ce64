#include "tests/bench/paths/octomap_paths.h"

#include <fmt/core.h>

#include "tests/temporary_folder.h"
#include "voxlist/planning/octomap.h"

namespace voxlist::bench {
namespace {

constexpr double kVoxel_m = 0.05, kSpacing_m = 0.7;

planning::OctomapBuilder octomap_of(const std::vector<PosedScan>& scans) {
  planning::OctomapConfig config;
  config.resolution_m = kVoxel_m;
  planning::OctomapBuilder octomap(config);
  for (const PosedScan& scan : scans) octomap.insert(to_pose3(scan.pose), scan.cloud);
  return octomap;
}

// Columns of voxels that are all free at the robot's heights.
FreeCells free_cells(const planning::OctomapBuilder& octomap, const Area& area, const Body& body) {
  const auto is_free = [&](const Eigen::Vector2d& p) {
    for (double z = (std::floor(body.low_m / kVoxel_m) + 0.5) * kVoxel_m;
         z < body.high_m + kVoxel_m / 2.0; z += kVoxel_m)
      if (octomap.at({p.x(), p.y(), z}) != planning::Occupancy::kFree) return false;
    return true;
  };
  // On the lattice of the voxels.
  const auto on_lattice = [](const Eigen::Vector2d& p) {
    return Eigen::Vector2d((p / kVoxel_m).array().floor() * kVoxel_m);
  };
  return {on_lattice(area.low), area.high, kVoxel_m, is_free};
}

}  // namespace

PathTally plan_in_octomap(int seed, int errands, const Body& body) {
  const simulation::Building building = simulation::make_building({.seed = seed});
  const planning::OctomapBuilder octomap =
      octomap_of(scans_along_tour(building, kSpacing_m, static_cast<std::uint64_t>(1000 * seed)));
  const FreeCells known = free_cells(octomap, area_of(building), body);
  const test::TemporaryFolder folder;
  octomap.write_bt(folder / "map.bt");
  simulation::Random random(4715, static_cast<std::uint64_t>(seed));
  PathTally tally;
  for (int i = 0; i < errands; ++i) {
    const Errand errand = random_errand(building, known, body, random);
    const auto path = points_of(fmt::format(
        "'" VOXLIST_BIN_DIR "/octomap_planner' '{}' {} {} {} {} {} {} {}",
        (folder / "map.bt").string(), body.radius_m + body.margin_m, body.low_m, body.high_m,
        errand.start.x(), errand.start.y(), errand.goal.x(), errand.goal.y()));
    tally.add(errand, path, building, known, body);
  }
  return tally;
}

}  // namespace voxlist::bench
