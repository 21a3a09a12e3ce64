#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace voxlist::adapter {

/// What a 3D laser says, before anything is done with it but the thinning.
struct RawCloud {
  std::int64_t utime_us = 0;

  /// Whatever the caller counts by; handed through to the cloud that this one completes.
  std::int64_t number = 0;

  /// Where each point lies in the sensor's frame (m). One that is not finite, or 0,0,0, is a ray
  /// that did not come back.
  std::vector<Eigen::Vector3f> points;

  /// When each point was measured, in the publisher's unit; empty: it does not tell.
  std::vector<float> times;

  /// Which of the message's `all_rows` each point was, from 0.
  std::vector<std::uint32_t> rows;
  std::uint32_t all_rows = 0;
};

}  // namespace voxlist::adapter
