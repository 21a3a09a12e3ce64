#pragma once

#include <filesystem>
#include <vector>

#include "services/voxlist/maps/scan_log.h"
#include "services/voxlist/maps/summary.h"
#include "services/voxlist/output/console.h"
#include "services/voxlist/output/fresh_file.h"
#include "voxlist/drawing/map_picture.h"
#include "voxlist/geometry/cloud.h"
#include "voxlist/mapping/graph/stored_graph.h"
#include "voxlist/mapping/keyframe_spool.h"
#include "voxlist/planning/octomap.h"

namespace voxlist::desk {

/// The files of a map folder. Each is replaced as a whole or not at all, the summary last; files of
/// others are left alone.
class MapFiles {
 public:
  /// Makes the folder. Throws FileError when nothing can be written there.
  explicit MapFiles(std::filesystem::path folder);

  /// Writes the keyframes of a map. Throws FileError.
  void write_keyframes(mapping::KeyframeSpool& spool,
                       const std::vector<mapping::SpooledKeyframe>& keyframes,
                       const VoxelMap& map) const;

  /// Writes what holds the keyframes that were written. Throws FileError.
  void write_graph(mapping::StoredGraph graph, const VoxelMap& map) const;

  /// Writes how sure the poses of the trajectory are that was written, where the folder's graph
  /// knows all of its so many keyframes, and what holds them. Throws FileError.
  void write_covariances(const std::vector<StampedPose3>& trajectory, std::size_t keyframes) const;

  /// Writes what was said of each scan; takes an older file away where none was localised. Throws
  /// FileError.
  void write_scan_log(const std::vector<ScanRow>& rows) const;

  /// Keeps edits of the map before aside, and tells where. Throws FileError.
  void give_up_edits(Console& console) const;

  /// Writes the edits of the map whose keyframes were written. Throws FileError.
  void write_edits(mapping::MapEdits edits, const VoxelMap& map) const;

  /// Writes trajectory, voxels and picture. Throws FileError.
  void write_views(const OccupancyMap& map, const std::vector<StampedPose3>& trajectory,
                   const drawing::ClosedLoops& closed = {}) const;

  /// Writes the OctoMap of the folder's keyframes, or takes the old one away where none is wanted
  /// or after Ctrl-C. So many threads mark rays at most; 0: as many as there are processors.
  void write_octomap(const planning::OctomapConfig& config, int threads, bool wanted,
                     Console& console) const;

  /// Writes the summary: the folder is whole.
  void write_summary(Summary summary);

 private:
  void remove_octomap() const;

  const std::filesystem::path folder_;
  FreshFile summary_;
};

}  // namespace voxlist::desk
