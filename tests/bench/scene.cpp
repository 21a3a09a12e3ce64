#include "tests/bench/scene.h"

#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "tests/matching/synthetic_room.h"
#include "voxlist/io/scans/scan_folder.h"

namespace voxlist::bench {
namespace {

constexpr std::size_t kQueryScan = 45;

std::filesystem::path hall_folder() {
  const char* data = std::getenv("VOXLIST_DATA");
  return std::filesystem::path(data ? data : VOXLIST_SOURCE_DIR "/../shared/data") / "hall";
}

Scene hall(const std::filesystem::path& folder) {
  const io::ScanFolder scans(folder);
  Scene result{"hall", VoxelMap(kFinestResolution_m), scans.read(kQueryScan).points,
               to_pose2(scans.truth(kQueryScan).value())};
  for (std::size_t i = 0; i < scans.size(); i += 2) {
    const auto T_map_base = scans.truth(i);
    if (!T_map_base) continue;
    for (const auto& p : scans.read(i).points) {
      const Eigen::Vector3d p_map = *T_map_base * p.cast<double>();
      if (in_lattice(p_map, kFinestResolution_m))
        result.map.insert(voxel_at(p_map, kFinestResolution_m));
    }
  }
  return result;
}

Scene room() {
  matching::SyntheticRoom made = matching::synthetic_room(12.0, 9.0, {4.3, 3.7, 0.9}, 5000, 1);
  return {"synthetic room", std::move(made.map), std::move(made.scan), made.truth};
}

Scene load() {
  const auto folder = hall_folder();
  Scene result = std::filesystem::exists(folder / "poses.csv") ? hall(folder) : room();
  std::printf("scene: %s, %zu voxels of 0.02 m, scan of %zu points\n", result.name.c_str(),
              result.map.size(), result.scan.size());
  return result;
}

}  // namespace

const Scene& scene() {
  static const Scene loaded = load();
  return loaded;
}

}  // namespace voxlist::bench
