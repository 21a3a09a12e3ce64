#pragma once

#include <filesystem>
#include <vector>

#include "services/voxlist/output/console.h"
#include "voxlist/mapping/map_builder.h"

namespace voxlist::desk {

/// The map of a folder, built from its keyframes.
struct StoredMap {
  mapping::MapBuilder builder;
  std::vector<StampedPose3> poses;  ///< T_map_base of each keyframe
};

/// Throws FileError when the folder holds no keyframe file.
void refuse_without_map(const std::filesystem::path& folder);

/// The folder's boxes that were edited by hand; tells what is wrong with their file.
mapping::MapEdits edits_of(const std::filesystem::path& folder, Console& console);

/// Reads a folder's map, a keyframe at a time; tells what is damaged. Throws FileError when there
/// is no map or an empty one, or after Ctrl-C.
StoredMap read_map(const std::filesystem::path& folder, const mapping::MapBuilderConfig& config,
                   Console& console);

/// The folder's trajectory.tum where it is of these keyframes, for it may tell the poses of scans
/// between them, too; with those keyframes that it lacks. Where it lacks more than half of them:
/// the keyframes' poses alone.
std::vector<StampedPose3> trajectory_of(const std::filesystem::path& folder,
                                        const std::vector<StampedPose3>& keyframes);

}  // namespace voxlist::desk
