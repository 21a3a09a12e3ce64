#include "voxlist/mapping/graph/spatial_edge.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "voxlist/geometry/elementary.h"

namespace voxlist::mapping {
namespace {

// Height, roll and pitch of a step that no surfaces tell are as the robot was tracked, and that
// sure (m, rad), a share of their distance, too: as unsure as any such step in the plane
// (neighbours.cpp).
constexpr double kUntold_m = 0.1, kUntoldShare = 0.05, kUntold_rad = 0.02;

// Where x, y and yaw are among six coordinates.
constexpr int kPlanar[] = {0, 1, 5};

// The turn about x, y and z (rad) that a rotation of less than half a turn is.
Eigen::Vector3d turn_of(const Eigen::Matrix3d& R) {
  const Eigen::Vector3d twice(R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1));
  const double sine = 0.5 * twice.norm(), cosine = 0.5 * (R.trace() - 1.0);
  if (sine == 0.0) return Eigen::Vector3d::Zero();
  return 0.5 * twice * (elementary::atan2(sine, cosine) / sine);
}

}  // namespace

Six miss(const Pose3& T_from_to, const Pose3& from, const Pose3& to) {
  const Pose3 seen = from.inverse() * to;
  Six missed;
  missed.head<3>() = seen.translation() - T_from_to.translation();
  missed.tail<3>() = turn_of(seen.linear() * T_from_to.linear().transpose());
  return missed;
}

double distance2(const SpatialEdge& edge, const std::vector<Pose3>& poses) {
  const Six missed = miss(edge.T_from_to.pose, poses[edge.from], poses[edge.to]);
  return missed.dot(edge.T_from_to.covariance.llt().solve(missed));
}

Pose3 stepped(const Pose3& pose, const Six& step) {
  Pose3 moved = pose;
  moved.translation() += step.head<3>();
  const Eigen::Vector3d turn = step.tail<3>();
  const double angle_rad = turn.norm();
  if (angle_rad > 0.0) moved.linear() = rotation(angle_rad, turn / angle_rad) * moved.linear();
  return moved;
}

UncertainPose3 lifted(const UncertainPose& planar) {
  const double height_m = kUntold_m + kUntoldShare * distance_m(planar.pose, {});
  UncertainPose3 space{to_pose3(planar.pose), Six2::Zero()};
  space.covariance.diagonal() << 0.0, 0.0, height_m * height_m, kUntold_rad * kUntold_rad,
      kUntold_rad * kUntold_rad, 0.0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) space.covariance(kPlanar[i], kPlanar[j]) = planar.covariance(i, j);
  return space;
}

UncertainPose3 between_leaning(const UncertainPose3& T_from_to, const Tilt& from, const Tilt& to) {
  const Pose3 T_base_level = to_level(from).inverse(), T_level_base = to_level(to);
  const Eigen::Matrix3d turned = T_base_level.linear();
  Six2 moved = Six2::Zero();
  moved.topLeftCorner<3, 3>() = moved.bottomRightCorner<3, 3>() = turned;
  moved.topRightCorner<3, 3>() =
      -turned * cross(T_from_to.pose.linear() * T_level_base.translation());
  return {T_base_level * T_from_to.pose * T_level_base,
          moved * T_from_to.covariance * moved.transpose()};
}

}  // namespace voxlist::mapping
