#include "services/voxlist/maps/map_files.h"

#include <fmt/core.h>

#include <cmath>
#include <fstream>
#include <optional>
#include <utility>

#include "services/voxlist/output/progress.h"
#include "services/voxlist/output/stop.h"
#include "voxlist/io/files/atomic_file.h"
#include "voxlist/io/files/file.h"
#include "voxlist/mapping/keyframe_reader.h"
#include "voxlist/mapping/map_store.h"
#include "voxlist/mapping/map_views.h"

namespace voxlist::desk {
namespace {

namespace fs = std::filesystem;

fs::path made(fs::path folder) {
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (!fs::is_directory(folder, failure)) {
    throw io::FileError(folder, "cannot be made a folder, check the name and its permissions");
  }
  return folder;
}

// The map's id follows from its content, so the same map has the same id. It is positive, never 0.
std::int64_t map_id(const VoxelMap& map) { return static_cast<std::int64_t>(map.hash() >> 1 | 1); }

// How far from its origin an OctoMap reaches: it has 2^16 voxels along each axis.
double reach_m(const planning::OctomapConfig& config) { return 32768.0 * config.resolution_m; }

bool is_beyond(const mapping::Keyframe& keyframe, const planning::OctomapConfig& config) {
  return keyframe.T_map_base.translation().cwiseAbs().maxCoeff() > reach_m(config);
}

void tell_what_lies_beyond(int beyond, const planning::OctomapConfig& config, Console& console) {
  if (beyond == 0) return;
  console.warn(
      fmt::format("{} keyframes lie beyond the {:.1f} km that map.bt reaches at {:g} m: "
                  "give a larger --octomap-resolution",
                  beyond, reach_m(config) / 1000.0, config.resolution_m));
}

void tell_if_shortened(double reach_m, Console& console) {
  if (std::isinf(reach_m)) return;
  console.warn(
      fmt::format("map.bt: a scan's rays pass too many voxels and free only {:.0f} m of "
                  "their way: give a larger --octomap-resolution",
                  reach_m));
}

}  // namespace

MapFiles::MapFiles(fs::path folder)
    : folder_(made(std::move(folder))), summary_(folder_ / "summary.json") {
  io::remove_stale_temporaries(folder_);
}

void MapFiles::write_keyframes(mapping::KeyframeSpool& spool,
                               const std::vector<mapping::SpooledKeyframe>& keyframes,
                               const VoxelMap& map) const {
  spool.write(folder_ / mapping::kKeyframeFile, map_id(map), keyframes);
}

void MapFiles::write_views(const VoxelMap& map, const std::vector<StampedPose3>& trajectory) const {
  mapping::write_map_views(folder_, map, trajectory);
}

void MapFiles::write_octomap(const planning::OctomapConfig& config, int threads, bool wanted,
                             Console& console) const {
  if (!wanted) return remove_octomap();
  mapping::KeyframeReader keyframes(folder_ / mapping::kKeyframeFile);
  planning::OctomapBuilder octomap(config);
  Progress progress(console, "making the OctoMap");
  int beyond = 0;
  const auto next = [&]() -> std::optional<planning::PosedCloud> {
    auto keyframe = keyframes.next();
    if (!keyframe) return std::nullopt;
    beyond += is_beyond(*keyframe, config);
    progress.show(keyframes.progress());
    return planning::PosedCloud{keyframe->T_map_base, std::move(keyframe->cloud)};
  };
  const bool whole = octomap.insert_all(next, threads, stop_requested);
  tell_what_lies_beyond(beyond, config, console);
  tell_if_shortened(octomap.reach_m(), console);
  if (whole && !stop_requested()) return octomap.write_bt(folder_ / "map.bt");
  remove_octomap();
  console.warn("interrupted: there is no map.bt");
}

void MapFiles::remove_octomap() const {
  std::error_code ignored;
  fs::remove(folder_ / "map.bt", ignored);
}

void MapFiles::write_summary(Summary summary) {
  summary["keyframe_bytes"] = fs::file_size(folder_ / mapping::kKeyframeFile);
  const std::string text = summary.dump(2, ' ', false, Summary::error_handler_t::replace);
  std::ofstream file(summary_.path());
  file << text << '\n';
  file.close();
  if (!file) throw io::FileError(folder_ / "summary.json", "cannot be written, check free space");
  summary_.publish();
}

}  // namespace voxlist::desk
