#pragma once

#include <filesystem>
#include <optional>

#include "services/voxlist/output/console.h"
#include "voxlist/planning/octomap.h"

namespace voxlist::desk {

/// The OctoMap of the keyframes of a map folder; nothing after Ctrl-C. Tells what is not in it. So
/// many threads mark rays at most; 0: as many as there are processors. Throws FileError.
std::optional<planning::OctomapBuilder> octomap_of(const std::filesystem::path& folder,
                                                   const planning::OctomapConfig& config,
                                                   int threads, Console& console);

}  // namespace voxlist::desk
