#include "voxlist/matching/motion/match_scatter.h"

#include "voxlist/matching/motion/pose_fusion.h"

namespace voxlist::matching {
namespace {

// The last so many scans count: as long as a street or a room stays about the same.
constexpr double kMemory = 30.0;
// So many scans that scatter by nothing are taken as seen before the first.
constexpr double kSeenBefore = 3.0;
// Larger differences (m, rad) are no scatter: wheels slip.
const Eigen::Vector3d kLargest{0.2, 0.2, 0.05};

// Where odometry and match differ by more than so many standard deviations, it is not by chance:
// wheels slipped, and odometry is the less sure for it.
constexpr double kByChance = 4.0;
// A match that pulls so many times farther than to its own place was made with a looser prior.
constexpr double kTooFar = 2.0;

}  // namespace

Eigen::Vector3d MatchScatter::variances() const {
  return (-products_ / (weight_ + kSeenBefore)).cwiseMax(0.0);
}

Eigen::Matrix3d MatchScatter::covariance(const Pose2& pose) const {
  const Eigen::Matrix3d turn = planar_turn(pose.yaw_rad);
  return turn * variances().asDiagonal() * turn.transpose();
}

UncertainPose MatchScatter::expected(const UncertainPose& guess) const {
  return {guess.pose, guess.covariance + covariance(guess.pose)};
}

void MatchScatter::correct(TrackedPose& moved, const UncertainPose& matched) {
  const UncertainPose guess = moved.pose(), prior = expected(guess);
  const Eigen::Matrix3d to_base = planar_turn(guess.pose.yaw_rad).transpose();
  learn(to_base * difference(matched.pose, guess.pose) - off_);
  const double surprise = mahalanobis2(matched.pose, expected(guess)) / (kByChance * kByChance);
  if (surprise > 1.0) moved.doubt(surprise);
  UncertainPose pose = fused(moved.pose(), prior, matched, covariance(guess.pose));
  const double way_m = distance_m(matched.pose, guess.pose);
  if (surprise > 1.0 && distance_m(pose.pose, guess.pose) > kTooFar * way_m)
    pose = fused(moved.pose(), expected(moved.pose()), matched, covariance(guess.pose));
  off_ = to_base * difference(matched.pose, pose.pose);
  moved.learn(pose);
}

// The way from the match before to this one, beside odometry's.
void MatchScatter::learn(const Eigen::Vector3d& difference) {
  const Eigen::Vector3d now = difference.cwiseMax(-kLargest).cwiseMin(kLargest);
  const double kept = 1.0 - 1.0 / kMemory;
  products_ = kept * products_ + now.cwiseProduct(last_);
  weight_ = kept * weight_ + 1.0;
  last_ = now;
}

}  // namespace voxlist::matching
