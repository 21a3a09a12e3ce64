#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "voxlist/mapping/edits/map_edits.h"

namespace voxlist::mapping {

/// Name of the edits in a map folder.
inline constexpr const char* kEditsFile = "edits.txt";

/// The edits as text, with a checksum.
std::string to_text(const MapEdits& edits);

/// Nothing when it is torn, or no edits of Voxlist.
std::optional<MapEdits> parse_edits(std::string_view text);

/// Replaces a map folder's edits as a whole. A file that is none of this map's edits is kept aside
/// (edits.txt.damaged, .damaged-1, ...). Throws FileError; then the old file is there.
void write_edits(const std::filesystem::path& folder, const MapEdits& edits);

/// Keeps the edits of a map that is given up under another name (edits.txt.given-up, ...), and
/// returns that; nothing where there are none. Throws FileError.
std::optional<std::filesystem::path> give_up_edits(const std::filesystem::path& folder);

/// What a folder has as the edits of a map.
struct FoundEdits {
  /// None where there is no such file, or one of no use.
  MapEdits edits;
  /// What is wrong with the file, and what that means, for people; empty where nothing is.
  std::string fault;
};

/// Reads the folder's edits of the map of that id.
FoundEdits find_edits(const std::filesystem::path& folder, std::optional<std::int64_t> map_id);

}  // namespace voxlist::mapping
