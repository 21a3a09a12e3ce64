#include "services/voxlist/report/run/folder.h"

#include "services/voxlist/maps/stored_map.h"
#include "services/voxlist/output/stop.h"
#include "voxlist/io/files/file.h"
#include "voxlist/mapping/keyframe_reader.h"
#include "voxlist/mapping/map_store.h"

namespace voxlist::desk {

MapFolder read_map_folder(const std::filesystem::path& path, Console& console) {
  refuse_without_map(path);
  MapFolder folder{path, {}, {}, {}, read_summary(path), {}};
  mapping::KeyframeReader reader(path / mapping::kKeyframeFile);
  mapping::MapBuilder builder;
  std::vector<StampedPose3> poses;
  while (!stop_requested()) {
    auto keyframe = reader.next();
    if (!keyframe) break;
    poses.push_back({keyframe->cloud.utime_us, keyframe->T_map_base});
    folder.keyframes.push_back(builder.add(std::move(*keyframe)));
  }
  if (!reader.warning().empty()) console.warn(reader.warning());
  if (poses.empty()) throw io::FileError(path, "holds an empty map, make one with voxlist map");
  builder.edit(edits_of(path, console));
  folder.map = builder.map();
  folder.trajectory = trajectory_of(path, poses);
  folder.scans = read_scan_log(path);
  return folder;
}

}  // namespace voxlist::desk
