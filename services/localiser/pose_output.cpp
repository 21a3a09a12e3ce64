#include "services/localiser/pose_output.h"

#include <voxlist/pose_t.hpp>
#include <voxlist/rigid_transform_t.hpp>
#include <voxlist/uncertain_pose_t.hpp>

#include "voxlist/bus/bus.h"
#include "voxlist/bus/convert.h"

namespace voxlist::services {

void PoseOutput::found(const Found& cloud, const UncertainPose& T_map_base, const Tilt& tilt,
                       const std::optional<Pose2>& T_odom_base) {
  cloud_ = cloud;
  tilt_ = tilt;
  T_map_odom_.reset();
  publish(cloud.utime_us, T_map_base);
  if (!T_odom_base) return;
  T_map_odom_ = T_map_base.pose * T_odom_base->inverse();
  bus_.publish(bus::kMapOdom, bus::to_transform({cloud.utime_us, *T_map_odom_}));
}

void PoseOutput::jump(const Pose2& T_new_old) {
  if (T_map_odom_) T_map_odom_ = T_new_old * *T_map_odom_;
  if (last_pose_) last_pose_->pose = T_new_old * last_pose_->pose;
}

void PoseOutput::lose() {
  T_map_odom_.reset();
  last_pose_.reset();
}

std::optional<Pose2> PoseOutput::at(const Pose2& T_odom_base) const {
  return T_map_odom_ ? std::optional(*T_map_odom_ * T_odom_base) : std::nullopt;
}

void PoseOutput::publish(std::int64_t utime_us, const UncertainPose& T_map_base) {
  publish_pose(utime_us, T_map_base.pose);
  uncertain_pose_t message{};
  message.utime = utime_us;
  message.map_id = cloud_.map_id;
  message.map_version = cloud_.map_version;
  message.cloud_utime = cloud_.utime_us;
  bus::write(T_map_base, message.pose, message.covariance);
  bus_.publish(bus::kPoseCovariance, message);
}

void PoseOutput::publish_pose(std::int64_t utime_us, const Pose2& pose) {
  pose_t message = bus::to_message(StampedPose3{utime_us, to_pose3(pose, tilt_)});
  // Velocities in base, over the step since the last POSE.
  if (last_pose_ && utime_us > last_pose_->utime_us) {
    const double dt_s = static_cast<double>(utime_us - last_pose_->utime_us) * 1e-6;
    const Pose2 step = last_pose_->pose.inverse() * pose;
    message.vel[0] = step.x_m / dt_s;
    message.vel[1] = step.y_m / dt_s;
    message.rotation_rate[2] = step.yaw_rad / dt_s;
  }
  if (!last_pose_ || utime_us > last_pose_->utime_us) last_pose_ = StampedPose2{utime_us, pose};
  bus_.publish(bus::kPose, message);
}

}  // namespace voxlist::services
