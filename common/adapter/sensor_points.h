#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "voxlist/adapter/point_times.h"
#include "voxlist/adapter/raw_cloud.h"
#include "voxlist/geometry/mount.h"

namespace voxlist::adapter {

/// What became of a point.
enum class PointFate {
  kPoint,
  kNoReturn,  ///< not finite, or 0,0,0
  kNoTime,    ///< its time is not finite
  kTooNear,
  kTooFar,
  kRobot,  ///< hit the robot itself
};
inline constexpr std::size_t kPointFates = 6;

/// How many points had each fate.
using PointCounts = std::array<std::int64_t, kPointFates>;

/// One sweep's points in base, each as it was when the point was measured.
struct TimedPoints {
  std::vector<Eigen::Vector3d> points;
  /// Seconds after utime_us; empty: all at that time.
  std::vector<float> offsets_s;
  std::int64_t utime_us = 0;
  /// The times of its earliest and its latest point.
  std::int64_t first_us = 0;
  std::int64_t last_us = 0;
  /// Where all its rays started, in base.
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  PointCounts counts{};
};

/// Turns what a sensor says into points in base.
class SensorPoints {
 public:
  /// Throws std::invalid_argument, with the setting's name, when the ranges leave nothing.
  explicit SensorPoints(const SensorConfig& sensor);

  /// Takes the points that are in range and not on the robot. `times` are the message's.
  TimedPoints place(const RawCloud& raw, const PointTimes& times, const BodyBoxes& robot) const;

 private:
  PointFate follow(const Eigen::Vector3f& point, const BodyBoxes& robot,
                   Eigen::Vector3d& point_base) const;

  Pose3 T_base_sensor_;
  double range_min_m_, range_max_m_;
  std::int64_t latency_us_;
};

}  // namespace voxlist::adapter
