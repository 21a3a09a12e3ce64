#include "voxlist/matching/motion/pose_hint.h"

namespace voxlist::matching {
namespace {

// A hint is good for so many scans: the first may be a bad one, and what it found is followed by
// then. A judgement: more only cost time where the hint is false.
constexpr int kScans = 3;

}  // namespace

void PoseHint::take(const UncertainPose& pose) {
  pose_ = pose;
  T_odom_base_.reset();
  scans_left_ = kScans;
}

std::optional<UncertainPose> PoseHint::next(const std::optional<Pose2>& T_odom_base) {
  if (scans_left_ == 0) return std::nullopt;
  --scans_left_;
  if (T_odom_base_ && T_odom_base)
    pose_.pose = pose_.pose * (T_odom_base_->inverse() * *T_odom_base);
  T_odom_base_ = T_odom_base;
  return pose_;
}

}  // namespace voxlist::matching
