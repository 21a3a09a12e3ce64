#include "voxlist/adapter/sensor_points.h"

#include <cmath>
#include <stdexcept>

namespace voxlist::adapter {
namespace {

std::int64_t to_us(double seconds) { return std::llround(seconds * 1e6); }

}  // namespace

SensorPoints::SensorPoints(const SensorConfig& sensor)
    : T_base_sensor_(mount_pose({sensor.mount_x_m, sensor.mount_y_m, sensor.mount_z_m},
                                sensor.mount_roll_deg, sensor.mount_pitch_deg,
                                sensor.mount_yaw_deg)),
      range_min_m_(sensor.range_min_m),
      range_max_m_(sensor.range_max_m),
      latency_us_(to_us(sensor.latency_ms * 1e-3)) {
  if (range_min_m_ >= range_max_m_)
    throw std::invalid_argument("range_min_m must be below range_max_m");
}

TimedPoints SensorPoints::place(const RawCloud& raw, const PointTimes& times,
                                const BodyBoxes& robot) const {
  TimedPoints placed;
  placed.utime_us = raw.utime_us - latency_us_;
  placed.first_us = placed.utime_us + to_us(times.first_s);
  placed.last_us = placed.utime_us + to_us(times.last_s);
  placed.origin = T_base_sensor_.translation();
  placed.points.reserve(raw.points.size());
  placed.offsets_s.reserve(times.offsets_s.size());
  for (std::size_t i = 0; i < raw.points.size(); ++i) {
    Eigen::Vector3d point;
    PointFate fate = follow(raw.points[i], robot, point);
    if (!times.offsets_s.empty() && std::isnan(times.offsets_s[i])) fate = PointFate::kNoTime;
    ++placed.counts[static_cast<std::size_t>(fate)];
    if (fate != PointFate::kPoint) continue;
    placed.points.push_back(point);
    if (!times.offsets_s.empty()) placed.offsets_s.push_back(times.offsets_s[i]);
  }
  return placed;
}

PointFate SensorPoints::follow(const Eigen::Vector3f& point, const BodyBoxes& robot,
                               Eigen::Vector3d& point_base) const {
  const Eigen::Vector3d point_sensor = point.cast<double>();
  const double range_m = point_sensor.norm();
  if (!std::isfinite(range_m) || range_m == 0.0) return PointFate::kNoReturn;
  if (range_m < range_min_m_) return PointFate::kTooNear;
  if (range_m > range_max_m_) return PointFate::kTooFar;
  point_base = T_base_sensor_ * point_sensor;
  return robot.hold(point_base) ? PointFate::kRobot : PointFate::kPoint;
}

}  // namespace voxlist::adapter
