#pragma once

#include <span>
#include <vector>

#include "voxlist/mapping/graph/pose_edge.h"

namespace voxlist::mapping {

/// Keyframes with one way from each to each other, mostly a drive as it went: where they stand by
/// that way, and how sure it is.
class PoseTree {
 public:
  /// Precondition: the edges, taken in their order, each join one more keyframe to those before;
  /// the first one's `from` is the root. One less than there are keyframes.
  PoseTree(std::size_t keyframes, std::span<const PoseEdge> edges);

  std::size_t size() const { return nodes_.size(); }

  /// T_root_keyframe of each.
  const Pose2& pose(std::size_t keyframe) const { return nodes_[keyframe].pose; }

  /// T_from_to by the way between them.
  UncertainPose between(std::size_t from, std::size_t to) const;

  /// How long that way is (m).
  double way_m(std::size_t from, std::size_t to) const;

 private:
  struct Node {
    std::size_t parent = 0;
    // An ancestor farther up, so that a way up takes few steps (Myers 1983: a skip list of one
    // more pointer).
    std::size_t jump = 0;
    std::size_t depth = 0;
    Pose2 pose;
    double way_m = 0.0;
    // Of the motion of the whole plane, in the root's axes, that the errors up to here make: sums
    // along the way, so that those of any part of it are a difference.
    Eigen::Matrix3d errors = Eigen::Matrix3d::Zero();
  };

  void add(const PoseEdge& edge);
  std::size_t up_to(std::size_t keyframe, std::size_t depth) const;
  const Node& meeting(std::size_t a, std::size_t b) const;

  std::vector<Node> nodes_;
};

/// The edges of a tree, in any order and told from either end, as PoseTree wants them: from
/// keyframe 0 on.
std::vector<PoseEdge> in_tree_order(std::span<const PoseEdge> edges);

}  // namespace voxlist::mapping
