#pragma once

// Only the .cpp files that encode messages include this file, as it brings protobuf's headers.
#include <foxglove.pb.h>

#include <Eigen/Geometry>
#include <cstdint>

#include "voxlist/foreign/foxglove/messages.h"

namespace voxlist::foreign {

inline void set_time(std::int64_t utime_us, google::protobuf::Timestamp& to) {
  to.set_seconds(utime_us / 1'000'000);
  to.set_nanos(static_cast<int>(utime_us % 1'000'000) * 1000);
}

template <class M>
void set_stamp(const Stamp& stamp, M& to) {
  set_time(stamp.utime_us, *to.mutable_timestamp());
  to.set_frame_id(stamp.frame);
}

inline void set(const Eigen::Vector3d& from, foxglove::Vector3& to) {
  to.set_x(from.x());
  to.set_y(from.y());
  to.set_z(from.z());
}

inline void set(const Eigen::Quaterniond& from, foxglove::Quaternion& to) {
  to.set_x(from.x());
  to.set_y(from.y());
  to.set_z(from.z());
  to.set_w(from.w());
}

inline Eigen::Quaterniond turn_of(const Pose3& pose) { return Eigen::Quaterniond(pose.linear()); }

inline void set(const Pose3& from, foxglove::Pose& to) {
  set(from.translation(), *to.mutable_position());
  set(turn_of(from), *to.mutable_orientation());
}

}  // namespace voxlist::foreign
