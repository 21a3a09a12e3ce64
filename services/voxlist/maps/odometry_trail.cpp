#include "services/voxlist/maps/odometry_trail.h"

#include <cstdlib>

#include "voxlist/matching/motion/tracked_pose.h"

namespace voxlist::desk {
namespace {

// How well a placed scan's pose is known (m, rad). A judgement: matches of sparse scans scatter by
// so much.
constexpr double kPlaced_m = 0.03, kPlaced_rad = 0.01;

UncertainPose placed_at(const Pose3& pose) {
  const Eigen::Vector3d sigmas(kPlaced_m, kPlaced_m, kPlaced_rad);
  return {to_pose2(pose), sigmas.cwiseAbs2().asDiagonal()};
}

}  // namespace

void OdometryTrail::note(std::int64_t utime_us, const std::optional<Pose2>& T_odom_base) {
  if (T_odom_base) T_odom_base_[utime_us] = *T_odom_base;
}

std::optional<UncertainPose> OdometryTrail::expect(const std::vector<StampedPose3>& placed,
                                                   std::int64_t utime_us) const {
  const StampedPose3 *before = nullptr, *after = nullptr;
  for (const StampedPose3& scan : placed) {
    if (scan.utime_us < utime_us && (!before || scan.utime_us > before->utime_us)) before = &scan;
    if (scan.utime_us > utime_us && (!after || scan.utime_us < after->utime_us)) after = &scan;
  }
  std::optional<UncertainPose> best;
  for (const StampedPose3* scan : {before, after}) {
    const auto expected = scan ? expect_from(*scan, utime_us) : std::nullopt;
    if (expected &&
        (!best || worst_sigma_m(expected->covariance) < worst_sigma_m(best->covariance)))
      best = expected;
  }
  return best;
}

std::optional<UncertainPose> OdometryTrail::expect_from(const StampedPose3& placed,
                                                        std::int64_t utime_us) const {
  const auto from = T_odom_base_.find(placed.utime_us), to = T_odom_base_.find(utime_us);
  if (from == T_odom_base_.end() || to == T_odom_base_.end()) return std::nullopt;
  matching::TrackedPose robot(placed_at(placed.pose));
  const auto away_us = std::abs(utime_us - placed.utime_us);
  robot.follow_odometry(from->second.inverse() * to->second, static_cast<double>(away_us) * 1e-6);
  return robot.pose();
}

}  // namespace voxlist::desk
