#include "services/voxlist/commands/edits/folder_edit.h"

#include <fmt/core.h>

#include <utility>

#include "services/voxlist/maps/stored_map.h"
#include "services/voxlist/output/console.h"
#include "services/voxlist/output/stop.h"
#include "voxlist/io/files/file.h"
#include "voxlist/mapping/edits/stored_edits.h"
#include "voxlist/mapping/keyframe_reader.h"
#include "voxlist/mapping/map_store.h"

namespace voxlist::desk {
namespace {

namespace fs = std::filesystem;

FileLock lock(const fs::path& folder) {
  const fs::path file = folder / mapping::kMapLock;
  if (auto lock = FileLock::take(file)) return std::move(*lock);
  throw io::FileError(folder,
                      fmt::format("process {} works in this map folder: give --live to have "
                                  "its mapper edit it",
                                  lock_owner(file)));
}

std::vector<StampedPose3> poses_of(const fs::path& folder) {
  mapping::KeyframeReader reader(folder / mapping::kKeyframeFile);
  std::vector<StampedPose3> poses;
  while (const auto keyframe = stop_requested() ? std::nullopt : reader.next())
    poses.push_back({keyframe->cloud.utime_us, keyframe->T_map_base});
  if (stop_requested()) throw io::FileError(folder, "interrupted, nothing was changed");
  return poses;
}

void add(const EditWish& wish, mapping::MapEdits& edits, Console& console) {
  const std::vector<StampedPose3> poses = poses_of(wish.folder);
  if (const std::string why = edits.refusal(wish.box(), poses); !why.empty())
    throw io::FileError(wish.folder, "was not edited: " + why);
  const std::int64_t id = edits.add(*wish.kind, wish.box(), poses);
  console.say(fmt::format("edit {}: {}", id, mapping::name_of(*wish.kind)));
}

void remove(const EditWish& wish, mapping::MapEdits& edits, Console& console) {
  if (!edits.remove(wish.id))
    throw io::FileError(wish.folder, fmt::format("has no edit {}, see voxlist edit {} list",
                                                 wish.id, wish.folder.string()));
  console.say(fmt::format("edit {} was taken back", wish.id));
}

std::string line_of(const mapping::MapEdit& edit, const Pose2& moved) {
  const Eigen::Vector3d &a = edit.box.min(), &b = edit.box.max();
  std::string line =
      fmt::format("{:5} {:7} {:9.2f} {:9.2f} {:9.2f} {:9.2f} {:9.2f} {:9.2f}", edit.id,
                  mapping::name_of(edit.kind), a.x(), a.y(), a.z(), b.x(), b.y(), b.z());
  if (moved != Pose2{})
    line +=
        fmt::format("  moved by {:.3f} {:.3f} m, {:.4f} rad", moved.x_m, moved.y_m, moved.yaw_rad);
  return line;
}

}  // namespace

int edit_folder(const EditWish& wish, Console& console) {
  refuse_without_map(wish.folder);
  const FileLock held = lock(wish.folder);
  mapping::MapEdits edits = edits_of(wish.folder, console);
  wish.kind ? add(wish, edits, console) : remove(wish, edits, console);
  mapping::write_edits(wish.folder, edits);
  console.say(fmt::format("to make its picture, points and OctoMap anew: voxlist rebuild {}",
                          wish.folder.string()));
  return 0;
}

int list_edits(const fs::path& folder, Console& console) {
  refuse_without_map(folder);
  const mapping::MapEdits edits = edits_of(folder, console);
  const std::vector<PlacedBox> placed = edits.placed(poses_of(folder));
  for (std::size_t i = 0; i < placed.size(); ++i)
    console.say(line_of(edits.edits[i], placed[i].T_map_box));
  if (placed.empty()) console.say("no edits");
  return 0;
}

}  // namespace voxlist::desk
