#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "services/voxlist/maps/scan_log.h"
#include "services/voxlist/maps/summary.h"
#include "services/voxlist/output/console.h"
#include "services/voxlist/report/page/entry.h"
#include "voxlist/io/poses/pose_file.h"
#include "voxlist/mapping/map_builder.h"

namespace voxlist::desk {

/// All that a map folder holds of the run that made it.
struct MapFolder {
  std::filesystem::path path;
  std::vector<mapping::Keyframe> keyframes;
  OccupancyMap map;
  std::vector<StampedPose3> trajectory;
  std::optional<Summary> summary;
  std::optional<std::vector<ScanRow>> scans;
};

/// Reads it; tells what is damaged. Throws io::FileError where there is no map.
MapFolder read_map_folder(const std::filesystem::path& path, Console& console);

/// What the run came to: counters of summary.json, and what the map covers.
Entry run_summary(const MapFolder& folder);

/// States and probabilities over time, and how long scans took.
Entry run_states(const MapFolder& folder);
Entry run_times(const MapFolder& folder);

/// Errors of the trajectory over time. Throws io::FileError where the truth is of another run.
Entry run_errors(const MapFolder& folder, const io::PoseTable& truth,
                 const std::filesystem::path& truth_file);

/// How near the map's surfaces are to those of a map of the same keyframes at their true poses, and
/// the other way round.
Entry run_surfaces(const MapFolder& folder, const io::PoseTable& truth);

}  // namespace voxlist::desk
