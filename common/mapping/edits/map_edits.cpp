#include "voxlist/mapping/edits/map_edits.h"

#include <algorithm>
#include <limits>

#include "voxlist/system/check.h"
#include "voxlist/voxels/edits/edit_limits.h"

namespace voxlist::mapping {
namespace {

std::size_t nearest_keyframe(const Eigen::Vector3d& point, const std::vector<StampedPose3>& map) {
  std::size_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < map.size(); ++i) {
    const double distance = (map[i].pose.translation() - point).squaredNorm();
    if (distance < least) nearest = i;
    least = std::min(least, distance);
  }
  return nearest;
}

// Keyframes that were lost from a file leave the numbers of those after them lower: the keyframe of
// that time is looked for about its place.
const StampedPose3* keyframe_of(const MapEdit& edit, const std::vector<StampedPose3>& map) {
  const auto is_it = [&](std::size_t i) {
    return i < map.size() && map[i].utime_us == edit.utime_us;
  };
  for (std::size_t away = 0; away <= std::max(edit.keyframe, map.size()); ++away) {
    if (away <= edit.keyframe && is_it(edit.keyframe - away)) return &map[edit.keyframe - away];
    if (is_it(edit.keyframe + away)) return &map[edit.keyframe + away];
  }
  return nullptr;
}

Pose2 moved(const MapEdit& edit, const std::vector<StampedPose3>& map) {
  const StampedPose3* const keyframe = keyframe_of(edit, map);
  if (!keyframe) return {};
  const Pose2 now = to_pose2(keyframe->pose);
  // One that was not moved moves nothing, not by a bit.
  return now == edit.T_map_keyframe ? Pose2{} : now * edit.T_map_keyframe.inverse();
}

}  // namespace

std::string MapEdits::refusal(const Eigen::AlignedBox3d& box,
                              const std::vector<StampedPose3>& map) const {
  if (map.empty()) return "the map is empty";
  std::vector<Eigen::AlignedBox3d> all = boxes();
  all.push_back(box);
  return fault_of(all);
}

std::int64_t MapEdits::add(EditKind kind, const Eigen::AlignedBox3d& box,
                           const std::vector<StampedPose3>& map) {
  VOXLIST_CHECK(refusal(box, map).empty(), "a box that cannot be added");
  const std::size_t keyframe = nearest_keyframe(box.center(), map);
  edits.push_back(
      {next_id, kind, box, keyframe, map[keyframe].utime_us, to_pose2(map[keyframe].pose)});
  ++changes;
  return next_id++;
}

bool MapEdits::remove(std::int64_t id) {
  if (std::erase_if(edits, [id](const MapEdit& edit) { return edit.id == id; }) == 0) return false;
  ++changes;
  return true;
}

void MapEdits::append(const MapEdits& other, std::size_t keyframes) {
  for (MapEdit edit : other.edits) {
    edit.id = next_id++;
    edit.keyframe += keyframes;
    edits.push_back(edit);
  }
  if (!other.edits.empty()) ++changes;
}

std::vector<Eigen::AlignedBox3d> MapEdits::boxes() const {
  std::vector<Eigen::AlignedBox3d> boxes;
  boxes.reserve(edits.size());
  for (const MapEdit& edit : edits) boxes.push_back(edit.box);
  return boxes;
}

std::vector<PlacedBox> MapEdits::placed(const std::vector<StampedPose3>& map) const {
  std::vector<PlacedBox> boxes;
  boxes.reserve(edits.size());
  for (const MapEdit& edit : edits) boxes.push_back({edit.kind, edit.box, moved(edit, map)});
  return boxes;
}

const char* name_of(EditKind kind) {
  if (kind == EditKind::kErase) return "erase";
  return kind == EditKind::kKeepFree ? "free" : "blocked";
}

}  // namespace voxlist::mapping
