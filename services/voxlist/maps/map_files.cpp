#include "services/voxlist/maps/map_files.h"

#include <fstream>
#include <utility>

#include "services/voxlist/maps/octomap_of.h"
#include "voxlist/io/files/atomic_file.h"
#include "voxlist/io/files/file.h"
#include "voxlist/mapping/edits/stored_edits.h"
#include "voxlist/mapping/graph/stored_graph.h"
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

}  // namespace

MapFiles::MapFiles(fs::path folder)
    : folder_(made(std::move(folder))), summary_(folder_ / "summary.json") {
  io::remove_stale_temporaries(folder_);
}

void MapFiles::write_keyframes(mapping::KeyframeSpool& spool,
                               const std::vector<mapping::SpooledKeyframe>& keyframes,
                               const VoxelMap& map) const {
  spool.write(folder_ / mapping::kKeyframeFile, map_id(map), keyframes);
  mapping::remove_graph(folder_);
}

void MapFiles::write_graph(mapping::StoredGraph graph, const VoxelMap& map) const {
  if (graph.keyframes.empty()) return;
  graph.map_id = map_id(map);
  mapping::write_graph(folder_, graph);
}

void MapFiles::write_covariances(const std::vector<StampedPose3>& trajectory,
                                 std::size_t keyframes) const {
  const mapping::KeyframeReader reader(folder_ / mapping::kKeyframeFile);
  const auto found = mapping::find_graph(folder_, reader.map_id());
  if (found.graph && found.graph->keyframes.size() == keyframes)
    mapping::write_covariances(folder_, *found.graph, trajectory);
}

void MapFiles::write_scan_log(const std::vector<ScanRow>& rows) const {
  if (!rows.empty()) return desk::write_scan_log(folder_, rows);
  std::error_code ignored;
  fs::remove(folder_ / kScanLogFile, ignored);
}

void MapFiles::give_up_edits(Console& console) const {
  if (const auto aside = mapping::give_up_edits(folder_))
    console.warn("the edits of the map before are kept as " + aside->string());
}

void MapFiles::write_edits(mapping::MapEdits edits, const VoxelMap& map) const {
  edits.map_id = map_id(map);
  mapping::write_edits(folder_, edits);
}

void MapFiles::write_views(const OccupancyMap& map, const std::vector<StampedPose3>& trajectory,
                           const drawing::ClosedLoops& closed) const {
  mapping::write_map_views(folder_, map, trajectory, closed);
}

void MapFiles::write_octomap(const planning::OctomapConfig& config, int threads, bool wanted,
                             Console& console) const {
  if (!wanted) return remove_octomap();
  const planning::OctomapCut cut = planning::cut_of(config);
  const auto octomap = octomap_of(folder_, config, threads, console);
  if (octomap) return octomap->write_bt(folder_ / "map.bt", cut);
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
