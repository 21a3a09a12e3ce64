#include "voxlist/bus/convert.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>
#include <voxlist/keyframe_t.hpp>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_hint_t.hpp>
#include <voxlist/pose_t.hpp>
#include <voxlist/rigid_transform_t.hpp>

#include "voxlist/geometry/time_limit.h"

namespace voxlist::bus {
namespace {

using Rows = std::vector<std::vector<float>>;

const std::array<std::string, 3> kOriginChannels = {"origin_x", "origin_y", "origin_z"};

// How far a quaternion's norm may be from 1: orientations come from single-precision senders too.
constexpr double kMaxNormError = 1e-3;

bool is_sane(const Eigen::Vector3f& point) {
  return point.allFinite() && point.cwiseAbs().maxCoeff() <= kMaxPoint_m;
}

std::optional<Pose3> make_pose(const double (&position)[3], const double (&quaternion)[4]) {
  const Eigen::Vector3d p(position);
  const Eigen::Quaterniond q(quaternion[0], quaternion[1], quaternion[2], quaternion[3]);
  const bool near = p.allFinite() && p.cwiseAbs().maxCoeff() <= kMaxPosition_m;
  // Written so that NaN fails.
  const bool unit = std::abs(q.norm() - 1.0) <= kMaxNormError;
  if (!near || !unit) return std::nullopt;
  return Eigen::Translation3d(p) * q.normalized();
}

void write_pose(const Pose3& pose, double (&position)[3], double (&quaternion)[4]) {
  Eigen::Map<Eigen::Vector3d> p(position);
  p = pose.translation();
  const Eigen::Quaterniond q(pose.linear());
  quaternion[0] = q.w();
  quaternion[1] = q.x();
  quaternion[2] = q.y();
  quaternion[3] = q.z();
}

// Adds point i unless it or its origin is no measurement. Returns how many were dropped.
std::int64_t add(const Eigen::Vector3f& point, const Eigen::Vector3f* origin, Cloud& cloud) {
  if (!is_sane(point) || (origin != nullptr && !is_sane(*origin))) return 1;
  if (point.isZero(0.0F) || (origin != nullptr && point == *origin)) return 1;
  cloud.points.push_back(point);
  if (origin != nullptr) cloud.origins.push_back(*origin);
  return 0;
}

bool all_have(const Rows& rows, std::size_t length) {
  return std::ranges::all_of(rows, [&](const auto& row) { return row.size() == length; });
}

Rows to_rows(const std::vector<Eigen::Vector3f>& points) {
  Rows rows;
  rows.reserve(points.size());
  for (const auto& p : points) rows.push_back({p.x(), p.y(), p.z()});
  return rows;
}

Eigen::Vector3f to_point(const std::vector<float>& row) { return {row[0], row[1], row[2]}; }

// The three origin channels in order x, y, z; empty when there are none. False: they make no sense.
bool find_origins(const pointcloud_t& message, std::vector<const std::vector<float>*>& found,
                  std::string& refusal) {
  for (const std::string& wanted : kOriginChannels) {
    const auto& names = message.channel_names;
    const auto n = std::ranges::count(names, wanted);
    if (n > 1) refusal = "repeated_channel";
    const auto at = std::ranges::find(names, wanted) - names.begin();
    if (n == 1) found.push_back(&message.channels[static_cast<std::size_t>(at)]);
  }
  if (refusal.empty() && found.size() % kOriginChannels.size() != 0) refusal = "partial_origins";
  return refusal.empty();
}

}  // namespace

bool is_sane_utime(std::int64_t utime_us) { return utime_us >= 0 && utime_us < kMaxUtime_us; }

ReceivedCloud from_message(const pointcloud_t& message) {
  ReceivedCloud result;
  std::vector<const std::vector<float>*> origins;
  if (!is_sane_utime(message.utime)) {
    result.refusal = "bad_utime";
  } else if (message.channels.size() != message.channel_names.size() ||
             !all_have(message.points, 3) || !all_have(message.channels, message.points.size())) {
    result.refusal = "ragged_arrays";
  } else if (find_origins(message, origins, result.refusal)) {
    Cloud& cloud = result.cloud.emplace();
    cloud.utime_us = message.utime;
    cloud.points.reserve(message.points.size());
    for (std::size_t i = 0; i < message.points.size(); ++i) {
      Eigen::Vector3f origin = Eigen::Vector3f::Zero();
      if (!origins.empty()) origin << (*origins[0])[i], (*origins[1])[i], (*origins[2])[i];
      result.dropped_points +=
          add(to_point(message.points[i]), origins.empty() ? nullptr : &origin, cloud);
    }
  }
  return result;
}

std::optional<StampedPose3> from_message(const pose_t& message) {
  const auto pose = make_pose(message.pos, message.orientation);
  if (!pose || !is_sane_utime(message.utime)) return std::nullopt;
  return StampedPose3{message.utime, *pose};
}

std::optional<UncertainPose> from_message(const pose_hint_t& message) {
  const Eigen::Vector2d position(message.pose[0], message.pose[1]);
  // Written so that NaN fails.
  const bool sane = position.allFinite() && position.cwiseAbs().maxCoeff() <= kMaxPosition_m &&
                    std::isfinite(message.pose[2]) && message.sigma_m > 0.0 &&
                    message.sigma_m <= kMaxPosition_m && message.sigma_rad > 0.0 &&
                    std::isfinite(message.sigma_rad) && is_sane_utime(message.utime);
  if (!sane) return std::nullopt;
  const double m2 = message.sigma_m * message.sigma_m;
  const double rad2 = message.sigma_rad * message.sigma_rad;
  return UncertainPose{{position.x(), position.y(), wrap_angle(message.pose[2])},
                       Eigen::Vector3d(m2, m2, rad2).asDiagonal()};
}

std::optional<PosedCloud> from_message(const keyframe_t& message) {
  const auto pose = make_pose(message.trans, message.quat);
  const bool has_origins = !message.origins.empty();
  if (!pose || !is_sane_utime(message.utime) || message.index < 0 ||
      (has_origins && message.origins.size() != message.points.size()) ||
      !all_have(message.points, 3) || !all_have(message.origins, 3)) {
    return std::nullopt;
  }
  PosedCloud keyframe{message.map_id, message.index, *pose, {}};
  keyframe.cloud.utime_us = message.utime;
  for (std::size_t i = 0; i < message.points.size(); ++i) {
    const Eigen::Vector3f origin =
        has_origins ? to_point(message.origins[i]) : Eigen::Vector3f::Zero().eval();
    add(to_point(message.points[i]), has_origins ? &origin : nullptr, keyframe.cloud);
  }
  return keyframe;
}

pointcloud_t to_message(const Cloud& cloud, const std::string& frame_id, std::int32_t seq) {
  pointcloud_t message{};
  message.utime = cloud.utime_us;
  message.seq = seq;
  message.frame_id = frame_id;
  message.n_points = static_cast<std::int32_t>(cloud.points.size());
  message.points = to_rows(cloud.points);
  if (cloud.origins.empty()) return message;
  message.n_channels = static_cast<std::int32_t>(kOriginChannels.size());
  message.channel_names.assign(kOriginChannels.begin(), kOriginChannels.end());
  message.channels.resize(kOriginChannels.size());
  for (const auto& origin : cloud.origins) {
    for (std::size_t axis = 0; axis < kOriginChannels.size(); ++axis) {
      message.channels[axis].push_back(origin[static_cast<Eigen::Index>(axis)]);
    }
  }
  return message;
}

pose_t to_message(const StampedPose3& pose) {
  pose_t message{};
  message.utime = pose.utime_us;
  write_pose(pose.pose, message.pos, message.orientation);
  return message;
}

pose_t to_message(const StampedPose2& pose) {
  return to_message(StampedPose3{pose.utime_us, to_pose3(pose.pose)});
}

void write(const UncertainPose& from, double (&pose)[3], double (&covariance)[9]) {
  pose[0] = from.pose.x_m;
  pose[1] = from.pose.y_m;
  pose[2] = from.pose.yaw_rad;
  for (int i = 0; i < 9; ++i) covariance[i] = from.covariance(i / 3, i % 3);
}

rigid_transform_t to_transform(const StampedPose2& T_a_b) {
  rigid_transform_t message{};
  message.utime = T_a_b.utime_us;
  write_pose(to_pose3(T_a_b.pose), message.trans, message.quat);
  return message;
}

keyframe_t to_message(const PosedCloud& keyframe) {
  keyframe_t message{};
  message.utime = keyframe.cloud.utime_us;
  message.map_id = keyframe.map_id;
  message.index = keyframe.index;
  write_pose(keyframe.T_map_base, message.trans, message.quat);
  message.points = to_rows(keyframe.cloud.points);
  message.n_points = static_cast<std::int32_t>(message.points.size());
  message.origins = to_rows(keyframe.cloud.origins);
  message.n_origins = static_cast<std::int32_t>(message.origins.size());
  return message;
}

}  // namespace voxlist::bus
