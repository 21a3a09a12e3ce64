#include "voxlist/mapping/edits/stored_edits.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "voxlist/io/files/atomic_file.h"
#include "voxlist/io/files/file.h"
#include "voxlist/io/files/keep_aside.h"
#include "voxlist/mapping/text/checked_text.h"
#include "voxlist/mapping/text/words.h"
#include "voxlist/voxels/edits/edit_limits.h"

namespace voxlist::mapping {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kTitle = "# voxlist edits 1";
constexpr std::array kKinds{EditKind::kErase, EditKind::kKeepFree, EditKind::kKeepBlocked};

// Without a precision, numbers are written so that reading gives the same bits.
void write(const MapEdit& edit, std::back_insert_iterator<std::string> out) {
  fmt::format_to(out, "{} {}", name_of(edit.kind), edit.id);
  for (const Eigen::Vector3d& corner : {edit.box.min(), edit.box.max()})
    fmt::format_to(out, " {} {} {}", corner.x(), corner.y(), corner.z());
  const Pose2& pose = edit.T_map_keyframe;
  fmt::format_to(out, " keyframe {} {} {} {} {}\n", edit.keyframe, edit.utime_us, pose.x_m,
                 pose.y_m, pose.yaw_rad);
}

Eigen::Vector3d read_corner(Words& words) {
  Eigen::Vector3d corner;
  for (double& coordinate : corner) coordinate = words.number<double>();
  return corner;
}

MapEdit read_edit(EditKind kind, Words& words) {
  MapEdit edit;
  edit.kind = kind;
  edit.id = words.number<std::int64_t>();
  edit.box.min() = read_corner(words);
  edit.box.max() = read_corner(words);
  words.is("keyframe");
  edit.keyframe = words.number<std::size_t>();
  edit.utime_us = words.number<std::int64_t>();
  edit.T_map_keyframe = words.pose();
  return edit;
}

bool moves_are_sane(const MapEdits& edits) {
  return std::ranges::all_of(edits.edits,
                             [](const MapEdit& edit) { return is_sane_move(edit.T_map_keyframe); });
}

std::optional<MapEdit> next_edit(Words& words) {
  for (const EditKind kind : kKinds)
    if (words.is(name_of(kind))) return read_edit(kind, words);
  return std::nullopt;
}

}  // namespace

std::string to_text(const MapEdits& edits) {
  std::string text(kTitle);
  const std::back_insert_iterator out(text);
  fmt::format_to(out, "\n# map {} changes {} next {}\n", edits.map_id, edits.changes,
                 edits.next_id);
  for (const MapEdit& edit : edits.edits) write(edit, out);
  return with_checksum(std::move(text));
}

std::optional<MapEdits> parse_edits(std::string_view text) {
  const auto body = whole_text(text);
  if (!body) return std::nullopt;
  Words words(*body);
  MapEdits edits;
  if (!words.is(kTitle) || !words.is("# map")) return std::nullopt;
  edits.map_id = words.number<std::int64_t>();
  words.is("changes");
  edits.changes = words.number<std::int64_t>();
  words.is("next");
  edits.next_id = words.number<std::int64_t>();
  while (auto edit = words.good() ? next_edit(words) : std::nullopt) edits.edits.push_back(*edit);
  const bool whole = words.good() && fault_of(edits.boxes()).empty() && moves_are_sane(edits);
  return whole ? std::optional(std::move(edits)) : std::nullopt;
}

void write_edits(const fs::path& folder, const MapEdits& edits) {
  if (!find_edits(folder, edits.map_id).fault.empty())
    io::keep_aside(folder / kEditsFile, ".damaged");
  io::write_file_atomically(folder / kEditsFile, to_text(edits));
}

std::optional<fs::path> give_up_edits(const fs::path& folder) {
  std::error_code ignored;
  if (!fs::exists(folder / kEditsFile, ignored)) return std::nullopt;
  const fs::path aside = io::keep_aside(folder / kEditsFile, ".given-up");
  fs::remove(folder / kEditsFile, ignored);
  return aside;
}

FoundEdits find_edits(const fs::path& folder, std::optional<std::int64_t> map_id) {
  const fs::path file = folder / kEditsFile;
  FoundEdits found;
  found.edits.map_id = map_id.value_or(0);
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return found;
  try {
    auto edits = parse_edits(io::read_file(file));
    if (edits && edits->map_id == map_id) return {std::move(*edits), {}};
    found.fault = fmt::format("{} is {}: the map has no edits", file.string(),
                              edits ? "of another map" : "torn");
  } catch (const io::FileError& failure) {
    found.fault = failure.what();
  }
  return found;
}

}  // namespace voxlist::mapping
