#include "voxlist/mapping/graph/stored_graph.h"

#include <fmt/core.h>

#include <Eigen/LU>
#include <algorithm>
#include <iterator>
#include <utility>

#include "voxlist/geometry/elementary.h"
#include "voxlist/geometry/tilt.h"
#include "voxlist/io/files/atomic_file.h"
#include "voxlist/io/files/file.h"
#include "voxlist/mapping/graph/pose_graph.h"
#include "voxlist/mapping/graph/spatial_g2o.h"
#include "voxlist/mapping/text/checked_text.h"
#include "voxlist/mapping/text/words.h"

namespace voxlist::mapping {
namespace {

constexpr std::string_view kTitle = "# voxlist graph 2";
// Its edges had their information in the axes of `from`, which no other program takes it to be in.
constexpr std::string_view kFirstTitle = "# voxlist graph 1";

using Out = std::back_insert_iterator<std::string>;

// Without a precision, numbers are written so that reading gives the same bits.
void write(const Pose2& pose, Out out) {
  fmt::format_to(out, " {} {} {}", pose.x_m, pose.y_m, pose.yaw_rad);
}

void write(const StoredGraph::Keyframe& keyframe, std::size_t number, Out out) {
  fmt::format_to(out, "VERTEX_SE2 {}", number);
  write(keyframe.T_map_keyframe, out);
  fmt::format_to(out, "\n# keyframe {} {} {}", keyframe.utime_us, int{keyframe.begins_session},
                 int{keyframe.T_odom_keyframe.has_value()});
  if (keyframe.T_odom_keyframe) write(*keyframe.T_odom_keyframe, out);
  fmt::format_to(out, "\n");
}

// The information about a miss in the axes of `to`, where the edge has it: so g2o means it.
Eigen::Matrix3d turned(const Eigen::Matrix3d& information, double yaw_rad) {
  const auto [sine, cosine] = elementary::sine_cosine(yaw_rad);
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() << cosine, -sine, sine, cosine;
  return turn.transpose() * information * turn;
}

void write(const PoseEdge& edge, Out out) {
  fmt::format_to(out, "EDGE_SE2 {} {}", edge.from, edge.to);
  write(edge.T_from_to.pose, out);
  const Eigen::Matrix3d information =
      turned(edge.T_from_to.covariance.inverse(), edge.T_from_to.pose.yaw_rad);
  for (int row = 0; row < 3; ++row)
    for (int column = row; column < 3; ++column)
      fmt::format_to(out, " {}", information(row, column));
  fmt::format_to(out, "\n");
}

Eigen::Matrix3d symmetric(Words& words) {
  Eigen::Matrix3d matrix;
  for (int row = 0; row < 3; ++row)
    for (int column = row; column < 3; ++column)
      matrix(row, column) = matrix(column, row) = words.number<double>();
  return matrix;
}

StoredGraph::Keyframe read_keyframe(Words& words) {
  StoredGraph::Keyframe keyframe;
  words.number<std::size_t>();
  keyframe.T_map_keyframe = words.pose();
  words.is("# keyframe");
  keyframe.utime_us = words.number<std::int64_t>();
  keyframe.begins_session = words.number<int>() != 0;
  if (words.number<int>() != 0) keyframe.T_odom_keyframe = words.pose();
  return keyframe;
}

PoseEdge read_edge(Words& words, bool is_first_format) {
  PoseEdge edge;
  edge.from = words.number<std::size_t>();
  edge.to = words.number<std::size_t>();
  edge.T_from_to.pose = words.pose();
  const double yaw_rad = is_first_format ? 0.0 : -edge.T_from_to.pose.yaw_rad;
  edge.T_from_to.covariance = turned(symmetric(words), yaw_rad).inverse();
  return edge;
}

double chi2_of(const StoredGraph& graph) {
  std::vector<Pose2> poses;
  for (const StoredGraph::Keyframe& keyframe : graph.keyframes)
    poses.push_back(keyframe.T_map_keyframe);
  return chi2(poses, graph.edges);
}

bool holds_together(const StoredGraph& graph) {
  const std::size_t size = graph.keyframes.size();
  return std::all_of(graph.edges.begin(), graph.edges.end(), [&](const PoseEdge& edge) {
    return edge.from < size && edge.to < size && edge.from != edge.to;
  });
}

}  // namespace

std::string to_g2o(const StoredGraph& graph) {
  const bool in_space = is_in_space(graph);
  std::string text(in_space ? kSpatialTitle : kTitle);
  const Out out(text);
  fmt::format_to(out, "\n# map {} moves {}\n", graph.map_id, graph.moves);
  fmt::format_to(out, "# chi2 {}\n", in_space ? chi2_in_space(graph) : chi2_of(graph));
  if (in_space) {
    write_in_space(graph, text);
    return with_checksum(std::move(text));
  }
  for (std::size_t i = 0; i < graph.keyframes.size(); ++i) write(graph.keyframes[i], i, out);
  if (!graph.keyframes.empty()) text += "FIX 0\n";
  for (const PoseEdge& edge : graph.edges) write(edge, out);
  return with_checksum(std::move(text));
}

std::optional<StoredGraph> parse_g2o(std::string_view text) {
  const auto body = whole_text(text);
  if (!body) return std::nullopt;
  Words words(*body);
  StoredGraph graph;
  const bool in_space = words.is(kSpatialTitle), is_first_format = words.is(kFirstTitle);
  if (!in_space && !is_first_format && !words.is(kTitle)) return std::nullopt;
  if (!words.is("# map")) return std::nullopt;
  graph.map_id = words.number<std::int64_t>();
  words.is("moves");
  graph.moves = words.number<std::int64_t>();
  if (words.is("# chi2")) words.number<double>();
  if (in_space) read_in_space(words, graph);
  while (words.good() && words.is("VERTEX_SE2")) graph.keyframes.push_back(read_keyframe(words));
  words.is("FIX 0");
  while (words.good() && words.is("EDGE_SE2"))
    graph.edges.push_back(read_edge(words, is_first_format));
  return words.good() && holds_together(graph) ? std::optional(std::move(graph)) : std::nullopt;
}

void write_graph(const std::filesystem::path& folder, const StoredGraph& graph) {
  io::write_file_atomically(folder / kGraphFile, to_g2o(graph));
}

void remove_graph(const std::filesystem::path& folder) {
  std::error_code ignored;
  std::filesystem::remove(folder / kGraphFile, ignored);
}

FoundGraph find_graph(const std::filesystem::path& folder, std::optional<std::int64_t> map_id) {
  const std::filesystem::path file = folder / kGraphFile;
  std::error_code error;
  FoundGraph found;
  if (!std::filesystem::exists(file, error)) return found;
  found.is_there = true;
  try {
    found.graph = parse_g2o(io::read_file(file));
    if (!found.graph) found.fault = file.string() + " is torn";
  } catch (const io::FileError& failure) {
    found.fault = failure.what();
  }
  if (!found.graph || found.graph->map_id == map_id) return found;
  found.fault = file.string() + " is of another map";
  found.graph.reset();
  return found;
}

void stand_at(const StoredGraph::Keyframe& keyframe, Pose3& T_map_base) {
  const Tilt tilt = tilt_of(T_map_base);
  if (keyframe.T_map_keyframe != to_pose2(T_map_base) || keyframe.tilt.value_or(tilt) != tilt)
    T_map_base = to_pose3(keyframe.T_map_keyframe, keyframe.tilt.value_or(tilt));
}

std::optional<StoredGraph::Keyframe> GraphPoses::next(std::int64_t utime_us) {
  const auto begin = keyframes_.begin() + static_cast<std::ptrdiff_t>(position_);
  const auto at = std::find_if(begin, keyframes_.end(), [&](const StoredGraph::Keyframe& keyframe) {
    return keyframe.utime_us == utime_us;
  });
  if (at == keyframes_.end()) return std::nullopt;
  position_ = static_cast<std::size_t>(at - keyframes_.begin()) + 1;
  return *at;
}

}  // namespace voxlist::mapping
