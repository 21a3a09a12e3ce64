#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "voxlist/matching/motion/tracked_pose.h"
#include "voxlist/matching/scan/floor.h"
#include "voxlist/voxels/voxel_map.h"

namespace voxlist::desk {

/// A scan that has no place in a map.
struct LostScan {
  std::int64_t number = 0;  ///< in the folder or log, from 0
  double seconds = 0.0;     ///< since the first scan
};

/// What a run that made or extended a map tells beside the map itself.
struct RunFigures {
  std::string input;
  std::int64_t scans = 0;
  std::int64_t placed = 0;
  std::int64_t lost = 0;
  std::int64_t ambiguous = 0;
  std::int64_t pieces = 0;               ///< parts of the drive that nothing joins to the map...
  std::int64_t in_pieces = 0;            ///< ...and their scans, which have no place in it
  std::int64_t without_pose = 0;         ///< not in the table of --use-poses
  std::int64_t left_out = 0;             ///< could not be read
  std::int64_t loops = 0;                ///< closed, each a look at ground of long before...
  std::int64_t loops_refused = 0;        ///< ...and those that would have moved the past too far
  double loops_moved_m = 0.0;            ///< how far they moved the keyframe that moved farthest
  std::optional<LostScan> first_lost;    ///< the first that was not placed at once
  std::optional<matching::Floor> floor;  ///< of the first scan that shows one
  bool odometry = false;                 ///< whether there was any
  std::optional<matching::OdometryBias> odometry_bias;  ///< what it is off by, as scans told
  Eigen::Vector3d offset_m = Eigen::Vector3d::Zero();   ///< taken off the poses of --use-poses
  double seconds = 0.0;                                 ///< of data
  double elapsed_seconds = 0.0;                         ///< of work, without writing files
  bool interrupted = false;
};

/// What summary.json of a map folder says.
using Summary = nlohmann::ordered_json;

/// Of a map that one run made.
Summary summary_of(const RunFigures& figures);

/// Of a map that had this summary before the run: the figures are added up, the input joins those
/// that extended it.
Summary extended(Summary summary, const RunFigures& figures);

/// Says what the map is now.
void describe(const VoxelMap& map, std::size_t keyframes, Summary& summary);

/// A folder's summary; nothing where there is none that can be read.
std::optional<Summary> read_summary(const std::filesystem::path& folder);

/// Whether one run of `voxlist map` made the folder's map, and nobody has added to it since: then
/// another run may replace it.
bool is_of_one_run(const std::filesystem::path& folder);

/// The map's hash as text, for people to compare.
std::string hash_text(const VoxelMap& map);

}  // namespace voxlist::desk
