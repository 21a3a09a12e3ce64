#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "voxlist/mapping/graph/pose_edge.h"

namespace voxlist::mapping {

/// Name of the graph in a map folder.
inline constexpr const char* kGraphFile = "graph.g2o";

/// Where a map's keyframes stand since its loops were closed, beside their file, in which they
/// stand where they were when they came.
struct StoredGraph {
  struct Keyframe {
    std::int64_t utime_us = 0;
    Pose2 T_map_keyframe;
    /// Odometry's pose at its time, if there was odometry.
    std::optional<Pose2> T_odom_keyframe = std::nullopt;
    /// It is the first of a session: the robot may have been carried there.
    bool begins_session = false;
    /// Its height, roll and pitch, where the graph tells them.
    std::optional<Tilt> tilt = std::nullopt;
  };

  std::int64_t map_id = 0;
  /// How often the map's keyframes were moved so far.
  std::int64_t moves = 0;
  /// Keyframes in the order of their file, which may have more: those appended since.
  std::vector<Keyframe> keyframes;
  /// What holds them: by the drive, which is one edge less than keyframes, then by loops.
  std::vector<PoseEdge> edges;
};

/// The graph as a g2o file: VERTEX_SE2 and EDGE_SE2; VERTEX_SE3:QUAT and EDGE_SE3:QUAT where all
/// edges are told in space. The information is of a miss in the axes of the pose that the edge goes
/// to. What g2o has no word for is in comments, and so is chi2, the sum over all edges where the
/// poses stand.
std::string to_g2o(const StoredGraph& graph);

/// Nothing when it is torn, or no graph of Voxlist.
std::optional<StoredGraph> parse_g2o(std::string_view text);

/// Replaces a map folder's graph as a whole. Throws FileError; then the old one is there.
void write_graph(const std::filesystem::path& folder, const StoredGraph& graph);

/// A map without a graph is in the folder now.
void remove_graph(const std::filesystem::path& folder);

/// What a folder has as the graph of a map.
struct FoundGraph {
  std::optional<StoredGraph> graph;
  /// Whether a file is there.
  bool is_there = false;
  /// Why it is of no use, for people; empty where it is, or there is none.
  std::string fault;
};

/// Reads the folder's graph of the map of that id.
FoundGraph find_graph(const std::filesystem::path& folder, std::optional<std::int64_t> map_id);

/// Puts a keyframe where a graph has it. One that was not moved stays as it is in every bit.
void stand_at(const StoredGraph::Keyframe& keyframe, Pose3& T_map_base);

/// Tells where keyframes stand, which come in the order of their file. Some of them may have been
/// lost, and some may be newer than the graph.
class GraphPoses {
 public:
  GraphPoses() = default;
  explicit GraphPoses(std::vector<StoredGraph::Keyframe> keyframes)
      : keyframes_(std::move(keyframes)) {}

  /// The next keyframe as the graph has it; nothing where the graph does not know it.
  std::optional<StoredGraph::Keyframe> next(std::int64_t utime_us);

 private:
  std::vector<StoredGraph::Keyframe> keyframes_;
  std::size_t position_ = 0;
};

}  // namespace voxlist::mapping
