#pragma once

#include <filesystem>
#include <string>

#include "services/voxlist/commands/map_run.h"
#include "services/voxlist/output/console.h"
#include "services/voxlist/output/fresh_file.h"
#include "voxlist/planning/octomap.h"

namespace voxlist::desk {

/// What the summary of a run tells beside the map itself.
struct RunFigures {
  std::string input;
  std::int64_t scans = 0;
  std::int64_t left_out = 0;                           ///< could not be read
  std::int64_t without_pose = 0;                       ///< not in the table of --use-poses
  Eigen::Vector3d offset_m = Eigen::Vector3d::Zero();  ///< taken off the poses of --use-poses
  double seconds = 0.0;                                ///< of data
  double elapsed_seconds = 0.0;                        ///< of work, without writing files
  bool interrupted = false;
};

/// The files of a map folder. Each is replaced as a whole or not at all, the summary last; files of
/// others are left alone.
class MapFiles {
 public:
  /// Makes the folder. Throws FileError when nothing can be written there, or a mapper works in it.
  explicit MapFiles(std::filesystem::path folder);

  /// Writes trajectory, voxels, picture and keyframes. Throws FileError.
  void write_map(const MapRun& run) const;

  /// Writes the OctoMap of the keyframes. False after Ctrl-C: then there is none, not even an old
  /// one.
  bool write_octomap(const mapping::MapBuilder& builder, const planning::OctomapConfig& config,
                     Console& console) const;

  /// Takes away the OctoMap of another map.
  void remove_octomap() const;

  /// Writes the summary: the folder is whole.
  void write_summary(const MapRun& run, const RunFigures& figures);

 private:
  const std::filesystem::path folder_;
  FreshFile summary_;
};

/// The map's hash as text, for people to compare.
std::string hash_text(const VoxelMap& map);

}  // namespace voxlist::desk
