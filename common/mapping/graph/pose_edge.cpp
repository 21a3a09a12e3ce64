#include "voxlist/mapping/graph/pose_edge.h"

#include <Eigen/LU>
#include <algorithm>

#include "voxlist/geometry/elementary.h"

namespace voxlist::mapping {

Eigen::Vector3d miss(const PoseEdge& edge, const Pose2& from, const Pose2& to) {
  const Pose2 seen = from.inverse() * to, &told = edge.T_from_to.pose;
  return {seen.x_m - told.x_m, seen.y_m - told.y_m, wrap_angle(seen.yaw_rad - told.yaw_rad)};
}

double distance2(const PoseEdge& edge, const std::vector<Pose2>& poses) {
  return mahalanobis2(poses[edge.from].inverse() * poses[edge.to], edge.T_from_to);
}

double worst_by_chance(double of_one, std::size_t edges) {
  // Chi squared's tail falls by exp(-x / 2), and somewhat slower: of a thousand edges with three or
  // six degrees of freedom, one exceeds it 1.4 or 2.8 times as often as wanted.
  return of_one + 2.0 * elementary::log(static_cast<double>(std::max<std::size_t>(edges, 1)));
}

PoseEdge reversed(const PoseEdge& edge) {
  const Pose2 &there = edge.T_from_to.pose, here{};
  const Eigen::Matrix3d moved = plane_by_pose(there, here).inverse() * plane_by_pose(here, there);
  return {
      edge.to, edge.from, {there.inverse(), moved * edge.T_from_to.covariance * moved.transpose()}};
}

Eigen::Matrix3d plane_by_pose(const Pose2& base, const Pose2& pose) {
  const auto [sine, cosine] = elementary::sine_cosine(base.yaw_rad);
  Eigen::Matrix3d moved;
  moved << cosine, -sine, pose.y_m, sine, cosine, -pose.x_m, 0.0, 0.0, 1.0;
  return moved;
}

}  // namespace voxlist::mapping
