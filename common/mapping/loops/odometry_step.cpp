#include "voxlist/mapping/loops/odometry_step.h"

#include <Eigen/LU>

#include "voxlist/matching/motion/pose_fusion.h"
#include "voxlist/matching/motion/tracked_pose.h"

namespace voxlist::mapping {
namespace {

// Odometry and a match agree within so many standard deviations (squared); of those that err as
// they say, 1 of 150 does not (three degrees of freedom).
constexpr double kAgree2 = 3.5 * 3.5;

}  // namespace

std::optional<UncertainPose> odometry_step(const DriveOdometry& odometry, std::size_t from,
                                           std::size_t to) {
  if (odometry.empty() || !odometry[from] || !odometry[to]) return std::nullopt;
  matching::TrackedPose pose(UncertainPose{});
  // The time that it took tells of the velocity only, which nobody asks for.
  pose.follow_odometry(odometry[from]->inverse() * *odometry[to], 1.0);
  return pose.pose();
}

bool agrees(const Pose2& T_from_to, const UncertainPose& told) {
  return mahalanobis2(T_from_to, told) <= kAgree2;
}

UncertainPose together(const UncertainPose& a, const UncertainPose& b) {
  const Eigen::Matrix3d ia = a.covariance.inverse(), ib = b.covariance.inverse();
  const Eigen::Matrix3d covariance = (ia + ib).inverse();
  const Eigen::Vector3d step = covariance * ib * matching::difference(b.pose, a.pose);
  return {{a.pose.x_m + step.x(), a.pose.y_m + step.y(), wrap_angle(a.pose.yaw_rad + step.z())},
          covariance};
}

UncertainPose with_odometry(const UncertainPose& matched,
                            const std::optional<UncertainPose>& told) {
  if (!told) return matched;
  const UncertainPose apart{told->pose, told->covariance + matched.covariance};
  return agrees(matched.pose, apart) ? together(matched, *told) : matched;
}

}  // namespace voxlist::mapping
