#include "services/voxlist/maps/stored_map.h"

#include <algorithm>
#include <map>
#include <utility>

#include "services/voxlist/output/stop.h"
#include "voxlist/io/files/file.h"
#include "voxlist/io/poses/trajectory.h"
#include "voxlist/mapping/edits/stored_edits.h"
#include "voxlist/mapping/keyframe_reader.h"
#include "voxlist/mapping/map_store.h"

namespace voxlist::desk {
namespace {

namespace fs = std::filesystem;
using Poses = std::vector<StampedPose3>;

// What writing a position with 9 decimals and a time to the microsecond costs (m).
constexpr double kSamePosition_m = 1e-6;

std::multimap<std::int64_t, Eigen::Vector3d> positions_of(const Poses& trajectory) {
  std::multimap<std::int64_t, Eigen::Vector3d> positions;
  for (const StampedPose3& pose : trajectory)
    positions.emplace(pose.utime_us, pose.pose.translation());
  return positions;
}

Poses without(const Poses& keyframes, const Poses& trajectory) {
  const auto positions = positions_of(trajectory);
  Poses missing;
  for (const StampedPose3& keyframe : keyframes) {
    const auto [begin, end] = positions.equal_range(keyframe.utime_us);
    const bool there = std::any_of(begin, end, [&](const auto& position) {
      return (position.second - keyframe.pose.translation()).norm() < kSamePosition_m;
    });
    if (!there) missing.push_back(keyframe);
  }
  return missing;
}

}  // namespace

void refuse_without_map(const fs::path& folder) {
  std::error_code ignored;
  if (!fs::exists(folder / mapping::kKeyframeFile, ignored))
    throw io::FileError(folder / mapping::kKeyframeFile,
                        "is not there; give the folder of a map, or make one with voxlist map");
}

mapping::MapEdits edits_of(const fs::path& folder, Console& console) {
  mapping::FoundEdits found = mapping::find_edits(
      folder, mapping::KeyframeReader(folder / mapping::kKeyframeFile).map_id());
  if (!found.fault.empty()) console.warn(found.fault);
  return std::move(found.edits);
}

StoredMap read_map(const fs::path& folder, const mapping::MapBuilderConfig& config,
                   Console& console) {
  refuse_without_map(folder);
  mapping::KeyframeReader reader(folder / mapping::kKeyframeFile);
  StoredMap map{mapping::MapBuilder(config), {}};
  while (!stop_requested()) {
    auto keyframe = reader.next();
    if (!keyframe) break;
    map.poses.push_back({keyframe->cloud.utime_us, keyframe->T_map_base});
    map.builder.add(std::move(*keyframe));
  }
  if (stop_requested()) throw io::FileError(folder, "interrupted, nothing was changed");
  if (!reader.warning().empty()) console.warn(reader.warning());
  if (map.poses.empty())
    throw io::FileError(folder, "holds an empty map, make one with voxlist map");
  map.builder.edit(edits_of(folder, console));
  return map;
}

Poses trajectory_of(const fs::path& folder, const Poses& keyframes) try {
  Poses trajectory = io::read_tum(folder / "trajectory.tum");
  const Poses missing = without(keyframes, trajectory);
  if (2 * missing.size() > keyframes.size()) return keyframes;
  trajectory.insert(trajectory.end(), missing.begin(), missing.end());
  return trajectory;
} catch (const io::FileError&) {
  return keyframes;
}

}  // namespace voxlist::desk
