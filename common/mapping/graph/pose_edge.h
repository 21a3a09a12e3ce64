#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "voxlist/geometry/uncertain_pose.h"
#include "voxlist/mapping/graph/spatial_edge.h"

namespace voxlist::mapping {

/// What is known of where one keyframe stands as another sees it. Keyframes are numbers from 0.
struct PoseEdge {
  std::size_t from = 0, to = 0;
  UncertainPose T_from_to{};
  /// The same in all six coordinates, between the robots as they lean; where maps are spatial.
  std::optional<UncertainPose3> in_space = std::nullopt;
};

/// By how much (m, m, rad; in from's axes) the poses of two keyframes, T_map_from and T_map_to,
/// miss an edge.
Eigen::Vector3d miss(const PoseEdge& edge, const Pose2& from, const Pose2& to);

/// The square of that in units of the edge's standard deviations: 3 in the mean of poses that err
/// as it says.
double distance2(const PoseEdge& edge, const std::vector<Pose2>& poses);

/// How large the worst of so many squares may be by chance, where one alone may be `of_one`: each
/// is to exceed it so many times more seldom.
double worst_by_chance(double of_one, std::size_t edges);

/// The same in the plane, told the other way round.
PoseEdge reversed(const PoseEdge& edge);

/// How a small motion of a pose (m, m, rad; in the axes of `base`) moves the whole plane, as seen
/// at its origin: what errors of several poses have in common.
Eigen::Matrix3d plane_by_pose(const Pose2& base, const Pose2& pose);

}  // namespace voxlist::mapping
