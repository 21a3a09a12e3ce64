#pragma once

#include <cstddef>
#include <vector>

#include "voxlist/geometry/pose.h"
#include "voxlist/geometry/tilt.h"
#include "voxlist/geometry/uncertain_pose.h"

namespace voxlist::mapping {

/// Shifts (m) and turns (rad) about x, y and z, and what belongs to two of them.
using Six = Eigen::Matrix<double, 6, 1>;
using Six2 = Eigen::Matrix<double, 6, 6>;

/// cross(a) * b is a x b.
inline Eigen::Matrix3d cross(const Eigen::Vector3d& a) {
  Eigen::Matrix3d matrix;
  matrix << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  return matrix;
}

/// A spatial pose T_a_b, and how sure it is.
struct UncertainPose3 {
  Pose3 pose = Pose3::Identity();
  /// Covariance of small shifts and turns of b, in a's axes, about b's origin: m^2, m rad, rad^2.
  Six2 covariance = Six2::Zero();
};

/// What is known in space of where one keyframe stands as another sees it.
struct SpatialEdge {
  std::size_t from = 0, to = 0;
  UncertainPose3 T_from_to;
};

/// What the poses of two keyframes, T_map_from and T_map_to, differ by from the T_from_to that is
/// told: shifts (m) and turns (rad) in from's axes.
Six miss(const Pose3& T_from_to, const Pose3& from, const Pose3& to);

/// The square of that in units of the edge's standard deviations: 6 in the mean of poses that err
/// as it says.
double distance2(const SpatialEdge& edge, const std::vector<Pose3>& poses);

/// A pose that is shifted and turned by a little, in the axes of its frame.
Pose3 stepped(const Pose3& pose, const Six& step);

/// A planar pose, as sure in height, roll and pitch as a robot was tracked that was made level.
UncertainPose3 lifted(const UncertainPose& planar);

/// What is told between two robots' level frames (to_level()), told between them as they lean.
UncertainPose3 between_leaning(const UncertainPose3& T_from_to, const Tilt& from, const Tilt& to);

}  // namespace voxlist::mapping
