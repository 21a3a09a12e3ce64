#include "voxlist/mapping/graph/pose_tree.h"

#include <Eigen/LU>
#include <utility>

#include "voxlist/system/check.h"

namespace voxlist::mapping {
PoseTree::PoseTree(std::size_t keyframes, std::span<const PoseEdge> edges) : nodes_(keyframes) {
  VOXLIST_CHECK(edges.size() + 1 == keyframes || (edges.empty() && keyframes == 0),
                "a tree has one edge less than keyframes");
  if (!edges.empty()) {
    Node& root = nodes_[edges.front().from];
    root.parent = root.jump = edges.front().from;
  }
  for (const PoseEdge& edge : edges) add(edge);
}

void PoseTree::add(const PoseEdge& edge) {
  const Node& from = nodes_[edge.from];
  const Pose2 pose = from.pose * edge.T_from_to.pose;
  const Eigen::Matrix3d moved = plane_by_pose(from.pose, pose);
  const Node &skipped = nodes_[from.jump], &next = nodes_[skipped.jump];
  const bool equal = from.depth - skipped.depth == skipped.depth - next.depth;
  nodes_[edge.to] = {edge.from,
                     equal ? skipped.jump : edge.from,
                     from.depth + 1,
                     pose,
                     from.way_m + distance_m(from.pose, pose),
                     from.errors + moved * edge.T_from_to.covariance * moved.transpose()};
}

UncertainPose PoseTree::between(std::size_t from, std::size_t to) const {
  const Node &a = nodes_[from], &b = nodes_[to];
  const Eigen::Matrix3d errors = a.errors + b.errors - 2.0 * meeting(from, to).errors;
  const Eigen::Matrix3d moved = plane_by_pose(a.pose, b.pose).inverse();
  return {a.pose.inverse() * b.pose, moved * errors * moved.transpose()};
}

double PoseTree::way_m(std::size_t from, std::size_t to) const {
  return nodes_[from].way_m + nodes_[to].way_m - 2.0 * meeting(from, to).way_m;
}

// Its ancestor at that depth, which is no more than its own.
std::size_t PoseTree::up_to(std::size_t keyframe, std::size_t depth) const {
  while (nodes_[keyframe].depth > depth) {
    const Node& node = nodes_[keyframe];
    keyframe = nodes_[node.jump].depth >= depth ? node.jump : node.parent;
  }
  return keyframe;
}

const PoseTree::Node& PoseTree::meeting(std::size_t a, std::size_t b) const {
  a = up_to(a, nodes_[b].depth);
  b = up_to(b, nodes_[a].depth);
  while (a != b) {
    const bool apart = nodes_[a].jump != nodes_[b].jump;
    a = apart ? nodes_[a].jump : nodes_[a].parent;
    b = apart ? nodes_[b].jump : nodes_[b].parent;
  }
  return nodes_[a];
}

std::vector<PoseEdge> in_tree_order(std::span<const PoseEdge> edges) {
  std::vector<std::vector<PoseEdge>> leaving(edges.size() + 1);
  for (const PoseEdge& edge : edges) {
    leaving[edge.from].push_back(edge);
    leaving[edge.to].push_back(reversed(edge));
  }
  std::vector<PoseEdge> ordered;
  std::vector<bool> reached(leaving.size());
  std::vector<std::size_t> ways{0};
  reached[0] = true;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    for (const PoseEdge& edge : leaving[ways[i]]) {
      if (reached[edge.to]) continue;
      reached[edge.to] = true;
      ordered.push_back(edge);
      ways.push_back(edge.to);
    }
  }
  return ordered;
}

}  // namespace voxlist::mapping
