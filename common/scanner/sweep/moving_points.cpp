#include "voxlist/scanner/sweep/moving_points.h"

#include "voxlist/geometry/odometry_buffer.h"
#include "voxlist/system/check.h"

namespace voxlist::scanner {

void MovingPoints::add(std::int64_t utime_us, const BeamHit& hit_base) {
  VOXLIST_CHECK(points_.empty() || utime_us >= points_.back().utime_us,
                "points come in the order of time");
  points_.push_back({utime_us, hit_base});
}

void MovingPoints::settle() {
  if (odometry_ == nullptr) return;
  if (const auto newest = odometry_->newest_utime_us()) settle_until(*newest);
}

std::optional<Cloud> MovingPoints::finish(std::int64_t utime_us) {
  if (odometry_ != nullptr) settle_until(utime_us);
  const std::optional<Pose3> T = T_base_points(utime_us);
  std::optional<Cloud> cloud;
  if (T && !lost_) {
    cloud.emplace();
    cloud->utime_us = utime_us;
    cloud->points.reserve(points_.size());
    cloud->origins.reserve(points_.size());
    for (const Point& p : points_) {
      cloud->points.push_back((*T * p.hit.point).cast<float>());
      cloud->origins.push_back((*T * p.hit.origin).cast<float>());
    }
  }
  clear();
  return cloud;
}

void MovingPoints::clear() {
  points_.clear();
  settled_ = 0;
  lost_ = false;
}

void MovingPoints::settle_until(std::int64_t utime_us) {
  for (; settled_ < points_.size() && points_[settled_].utime_us <= utime_us; ++settled_) {
    Point& p = points_[settled_];
    const auto T_odom_base = odometry_->estimate(p.utime_us, max_extrapolation_us_);
    if (!T_odom_base) {
      lost_ = true;
      continue;
    }
    const Pose3 T = to_pose3(*T_odom_base);
    p.hit = {T * p.hit.origin, T * p.hit.point};
  }
}

// Takes settled points, which are in odom, to base at a time. The identity where the robot stands.
std::optional<Pose3> MovingPoints::T_base_points(std::int64_t utime_us) const {
  if (odometry_ == nullptr) return Pose3::Identity();
  const auto T_odom_base = odometry_->estimate(utime_us, max_extrapolation_us_);
  if (!T_odom_base) return std::nullopt;
  return to_pose3(T_odom_base->inverse());
}

}  // namespace voxlist::scanner
