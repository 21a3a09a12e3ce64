#include "voxlist/mapping/graph/spatial_g2o.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <iterator>
#include <string>

namespace voxlist::mapping {
namespace {

using Out = std::back_insert_iterator<std::string>;

Pose3 pose_of(const StoredGraph::Keyframe& keyframe) {
  return to_pose3(keyframe.T_map_keyframe, keyframe.tilt.value_or(Tilt{}));
}

// An edge in space; one that no surfaces told there is as the plane has it.
UncertainPose3 told_of(const StoredGraph& graph, const PoseEdge& edge) {
  if (edge.in_space) return *edge.in_space;
  const auto tilt = [&](std::size_t i) { return graph.keyframes[i].tilt.value_or(Tilt{}); };
  return between_leaning(lifted(edge.T_from_to), tilt(edge.from), tilt(edge.to));
}

void write(const Pose3& pose, Out out) {
  const Eigen::Quaterniond turned(pose.linear());
  const double sign = turned.w() < 0.0 ? -1.0 : 1.0;
  const Eigen::Vector3d at = pose.translation();
  fmt::format_to(out, " {} {} {} {} {} {} {}", at.x(), at.y(), at.z(), sign * turned.x(),
                 sign * turned.y(), sign * turned.z(), sign * turned.w());
}

void write(const Pose2& pose, Out out) {
  fmt::format_to(out, " {} {} {}", pose.x_m, pose.y_m, pose.yaw_rad);
}

template <int kSize>
void write_upper(const Eigen::Matrix<double, kSize, kSize>& matrix, Out out) {
  for (int row = 0; row < kSize; ++row)
    for (int column = row; column < kSize; ++column)
      fmt::format_to(out, " {}", matrix(row, column));
  fmt::format_to(out, "\n");
}

// A quaternion has no bits to spare for the exact pose: that is in the comment.
void write(const StoredGraph::Keyframe& keyframe, std::size_t number, Out out) {
  const Tilt tilt = keyframe.tilt.value_or(Tilt{});
  fmt::format_to(out, "VERTEX_SE3:QUAT {}", number);
  write(pose_of(keyframe), out);
  fmt::format_to(out, "\n# keyframe {} {} {}", keyframe.utime_us, int{keyframe.begins_session},
                 int{keyframe.T_odom_keyframe.has_value()});
  if (keyframe.T_odom_keyframe) write(*keyframe.T_odom_keyframe, out);
  fmt::format_to(out, " stands");
  write(keyframe.T_map_keyframe, out);
  fmt::format_to(out, " {} {} {}\n", tilt.z_m, tilt.roll_rad, tilt.pitch_rad);
}

// How g2o has a miss: in the axes of the pose that the edge goes to, turns as the first three parts
// of a quaternion, which are half of them.
Six2 miss_of_g2o(const Pose3& T_from_to) {
  Six2 A = Six2::Zero();
  A.topLeftCorner<3, 3>() = T_from_to.linear().transpose();
  A.bottomRightCorner<3, 3>() = 0.5 * T_from_to.linear().transpose();
  return A;
}

void write(const StoredGraph& graph, const PoseEdge& edge, Out out) {
  const UncertainPose3 told = told_of(graph, edge);
  const Six2 turned = miss_of_g2o(told.pose);
  fmt::format_to(out, "EDGE_SE3:QUAT {} {}", edge.from, edge.to);
  write(told.pose, out);
  write_upper<6>((turned * told.covariance * turned.transpose()).inverse(), out);
  fmt::format_to(out, "# plane");
  write(edge.T_from_to.pose, out);
  write_upper<3>(edge.T_from_to.covariance, out);
}

Pose3 read_pose3(Words& words) {
  Pose3 pose = Pose3::Identity();
  for (int i = 0; i < 3; ++i) pose.translation()[i] = words.number<double>();
  Eigen::Quaterniond turned;
  for (double* part : {&turned.x(), &turned.y(), &turned.z(), &turned.w()})
    *part = words.number<double>();
  pose.linear() = turned.normalized().toRotationMatrix();
  return pose;
}

template <int kSize>
Eigen::Matrix<double, kSize, kSize> read_upper(Words& words) {
  Eigen::Matrix<double, kSize, kSize> matrix;
  for (int row = 0; row < kSize; ++row)
    for (int column = row; column < kSize; ++column)
      matrix(row, column) = matrix(column, row) = words.number<double>();
  return matrix;
}

StoredGraph::Keyframe read_keyframe(Words& words) {
  StoredGraph::Keyframe keyframe;
  words.number<std::size_t>();
  read_pose3(words);
  words.is("# keyframe");
  keyframe.utime_us = words.number<std::int64_t>();
  keyframe.begins_session = words.number<int>() != 0;
  if (words.number<int>() != 0) keyframe.T_odom_keyframe = words.pose();
  words.is("stands");
  keyframe.T_map_keyframe = words.pose();
  Tilt& tilt = keyframe.tilt.emplace();
  for (double* part : {&tilt.z_m, &tilt.roll_rad, &tilt.pitch_rad}) *part = words.number<double>();
  return keyframe;
}

PoseEdge read_edge(Words& words) {
  PoseEdge edge;
  edge.from = words.number<std::size_t>();
  edge.to = words.number<std::size_t>();
  UncertainPose3& told = edge.in_space.emplace();
  told.pose = read_pose3(words);
  const Six2 back = miss_of_g2o(told.pose).inverse();
  told.covariance = back * read_upper<6>(words).inverse() * back.transpose();
  words.is("# plane");
  edge.T_from_to.pose = words.pose();
  edge.T_from_to.covariance = read_upper<3>(words);
  return edge;
}

}  // namespace

bool is_in_space(const StoredGraph& graph) {
  return std::any_of(graph.keyframes.begin(), graph.keyframes.end(), [](const auto& keyframe) {
    return keyframe.tilt && *keyframe.tilt != Tilt{};
  });
}

void write_in_space(const StoredGraph& graph, std::string& text) {
  const Out out(text);
  for (std::size_t i = 0; i < graph.keyframes.size(); ++i) write(graph.keyframes[i], i, out);
  text += "FIX 0\n";
  for (const PoseEdge& edge : graph.edges) write(graph, edge, out);
}

void read_in_space(Words& words, StoredGraph& graph) {
  while (words.good() && words.is("VERTEX_SE3:QUAT"))
    graph.keyframes.push_back(read_keyframe(words));
  words.is("FIX 0");
  while (words.good() && words.is("EDGE_SE3:QUAT")) graph.edges.push_back(read_edge(words));
}

double chi2_in_space(const StoredGraph& graph) {
  std::vector<Pose3> poses;
  for (const StoredGraph::Keyframe& keyframe : graph.keyframes) poses.push_back(pose_of(keyframe));
  double sum = 0.0;
  for (const PoseEdge& edge : graph.edges)
    sum += distance2(SpatialEdge{edge.from, edge.to, told_of(graph, edge)}, poses);
  return sum;
}

}  // namespace voxlist::mapping
