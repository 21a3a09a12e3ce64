#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "voxlist/mapping/graph/stored_graph.h"
#include "voxlist/mapping/loops/look_memory.h"

namespace voxlist::mapping {

/// Name of the file in a map folder that has the looks for loops that were taken, those that found
/// nothing or were not believed among them: after a restart none is taken again. It only saves
/// time: whoever removes it loses nothing else.
inline constexpr const char* kLooksFile = "looks.voxlist";

/// Replaces the folder's looks as a whole. `keyframes`: those that the looks are of, in the order
/// of their file. Throws FileError; then the old ones are there.
void write_looks(const std::filesystem::path& folder, std::int64_t map_id,
                 const std::vector<StoredGraph::Keyframe>& keyframes, const LookMemory& memory);

/// Takes the folder's looks into an empty memory, if they are of these keyframes, which may have
/// become more since, and were taken by this version of the program. Otherwise the memory stays
/// empty. Returns why the file is of no use, for people: it is torn, or the disk cannot be read;
/// empty where it is, or is not there, or is of other keyframes or another version.
std::string read_looks(const std::filesystem::path& folder, std::int64_t map_id,
                       const std::vector<StoredGraph::Keyframe>& keyframes, LookMemory& memory);

}  // namespace voxlist::mapping
