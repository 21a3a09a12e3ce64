#include "voxlist/geometry/tilt.h"

#include "voxlist/geometry/elementary.h"

namespace voxlist {

Pose3 to_level(const Tilt& tilt) {
  Pose3 T = Pose3::Identity();
  T.translation().z() = tilt.z_m;
  T.linear() = rotation(tilt.pitch_rad, Eigen::Vector3d::UnitY()) *
               rotation(tilt.roll_rad, Eigen::Vector3d::UnitX());
  return T;
}

Pose3 to_pose3(const Pose2& planar, const Tilt& tilt) { return to_pose3(planar) * to_level(tilt); }

Tilt tilt_of(const Pose3& pose) {
  const auto& R = pose.linear();
  return {pose.translation().z(), elementary::atan2(R(2, 1), R(2, 2)),
          elementary::atan2(-R(2, 0), elementary::hypot(R(2, 1), R(2, 2)))};
}

double lean_rad(const Tilt& tilt) {
  const Eigen::Vector3d up = to_level(tilt).linear().col(2);
  return elementary::atan2(elementary::hypot(up.x(), up.y()), up.z());
}

Cloud moved(const Pose3& T_a_b, const Cloud& cloud) {
  Cloud result{cloud.utime_us, {}, {}};
  const Eigen::Isometry3f T = T_a_b.cast<float>();
  result.points.reserve(cloud.points.size());
  for (const Eigen::Vector3f& point : cloud.points) result.points.push_back(T * point);
  // Without origins all rays start at b's.
  if (cloud.origins.empty() && T.translation().isZero(0.0F)) return result;
  result.origins.reserve(cloud.points.size());
  for (std::size_t i = 0; i < cloud.points.size(); ++i)
    result.origins.push_back(T * cloud.origin(i));
  return result;
}

}  // namespace voxlist
