#include "services/voxlist/commands/map_files.h"

#include <fmt/core.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>

#include "services/voxlist/output/progress.h"
#include "services/voxlist/output/stop.h"
#include "voxlist/io/files/atomic_file.h"
#include "voxlist/io/files/file.h"
#include "voxlist/mapping/map_store.h"
#include "voxlist/mapping/map_views.h"
#include "voxlist/system/version.h"

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

void tell_what_lies_beyond(const mapping::MapBuilder& builder,
                           const planning::OctomapConfig& config, Console& console) {
  const auto is_beyond = [&](const mapping::Keyframe& keyframe) {
    return keyframe.T_map_base.translation().cwiseAbs().maxCoeff() > reach_m(config);
  };
  const auto beyond = std::ranges::count_if(builder.keyframes(), is_beyond);
  if (beyond == 0) return;
  console.warn(
      fmt::format("{} keyframes lie beyond the {:.1f} km that map.bt reaches at {:g} m: "
                  "give a larger --octomap-resolution",
                  beyond, reach_m(config) / 1000.0, config.resolution_m));
}

}  // namespace

MapFiles::MapFiles(fs::path folder)
    : folder_(made(std::move(folder))), summary_(folder_ / "summary.json") {
  mapping::refuse_folder_in_use(folder_);
  io::remove_stale_temporaries(folder_);
}

void MapFiles::write_map(const MapRun& run) const {
  const VoxelMap& map = run.builder().map().occupied;
  mapping::write_map_views(folder_, map, run.trajectory());
  mapping::write_keyframes(folder_, map_id(map), run.builder().keyframes());
}

bool MapFiles::write_octomap(const mapping::MapBuilder& builder,
                             const planning::OctomapConfig& config, Console& console) const {
  tell_what_lies_beyond(builder, config, console);
  planning::OctomapBuilder octomap(config);
  Progress progress(console, "making the OctoMap");
  const auto& keyframes = builder.keyframes();
  for (std::size_t i = 0; i < keyframes.size() && !stop_requested(); ++i) {
    octomap.insert(keyframes[i].T_map_base, keyframes[i].cloud, stop_requested);
    progress.show(static_cast<double>(i + 1) / static_cast<double>(keyframes.size()));
  }
  if (stop_requested()) {
    remove_octomap();
    return false;
  }
  octomap.write_bt(folder_ / "map.bt");
  return true;
}

void MapFiles::remove_octomap() const {
  std::error_code ignored;
  fs::remove(folder_ / "map.bt", ignored);
}

void MapFiles::write_summary(const MapRun& run, const RunFigures& figures) {
  const VoxelMap& map = run.builder().map().occupied;
  const double factor =
      figures.elapsed_seconds > 0.0 ? figures.seconds / figures.elapsed_seconds : 0.0;
  nlohmann::ordered_json json = {
      {"input", figures.input},
      {"version", version()},
      {"scans", figures.scans},
      {"placed", run.trajectory().size()},
      {"lost", run.lost()},
      {"ambiguous", run.ambiguous()},
      {"without_pose", figures.without_pose},
      {"left_out", figures.left_out},
      {"keyframes", run.builder().keyframes().size()},
      {"offset_m", {figures.offset_m.x(), figures.offset_m.y(), figures.offset_m.z()}},
      {"seconds", figures.seconds},
      {"elapsed_seconds", figures.elapsed_seconds},
      {"real_time_factor", factor},
      {"map_hash", hash_text(map)},
      {"voxels", map.size()},
      {"resolution_m", map.resolution_m()},
      {"interrupted", figures.interrupted},
  };
  const std::string text = json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace);
  std::ofstream file(summary_.path());
  file << text << '\n';
  file.close();
  if (!file) throw io::FileError(folder_ / "summary.json", "cannot be written, check free space");
  summary_.publish();
}

std::string hash_text(const VoxelMap& map) { return fmt::format("{:016x}", map.hash()); }

}  // namespace voxlist::desk
