#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "voxlist/geometry/pose.h"

namespace voxlist {

/// One 3D scan: the points of one sweep, all in one frame (base unless said otherwise) at one time.
struct Cloud {
  /// Time of the data, microseconds since the epoch (or since the recording's start).
  std::int64_t utime_us = 0;

  /// Hits, metres. All finite: readers and decoders drop the others.
  std::vector<Eigen::Vector3f> points;

  /// Where each ray started (for the mirror scanner the hit point on the mirror axis, not the
  /// laser), metres, same frame. Empty: every ray started at the frame's origin. Otherwise as long
  /// as `points`.
  std::vector<Eigen::Vector3f> origins;

  /// Where ray i started.
  Eigen::Vector3f origin(std::size_t i) const {
    return origins.empty() ? Eigen::Vector3f::Zero().eval() : origins[i];
  }
};

/// A pose that holds at a time.
struct StampedPose2 {
  std::int64_t utime_us = 0;
  Pose2 pose;
};

struct StampedPose3 {
  std::int64_t utime_us = 0;
  Pose3 pose = Pose3::Identity();
};

}  // namespace voxlist
