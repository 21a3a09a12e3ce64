#pragma once

#include <filesystem>
#include <vector>

#include "services/voxlist/output/console.h"
#include "voxlist/planning/profiles/robot_profile.h"

namespace voxlist::desk {

/// Writes NAME_scan.csv for each robot into a folder: the 2D scan of each of the map's keyframes,
/// its place first, then a range for each bearing (inf: nothing seen, nan: no ray there); and
/// NAME_scan_far.csv, the furthest points. Throws FileError.
void write_virtual_scans(const std::filesystem::path& map, const std::filesystem::path& folder,
                         const std::vector<planning::RobotProfile>& robots, Console& console);

}  // namespace voxlist::desk
