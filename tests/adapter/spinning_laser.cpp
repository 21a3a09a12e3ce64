#include "tests/adapter/spinning_laser.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "voxlist/geometry/mount.h"

namespace voxlist::adapter::test {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kRings = 16;
constexpr double kSweep_s = 0.1;

// A point as the laser sees it, and when.
struct Shot {
  double after_s;
  Eigen::Vector3f point;
};

// Ring by ring within each column, as a laser fires them; it turns clockwise.
Shot shot(int i, int columns) {
  const int column = i / kRings, ring = i % kRings;
  const double share = static_cast<double>(i) / (columns * kRings);
  const double azimuth_rad = kPi - 2.0 * kPi * column / columns;
  const double elevation_rad = (2.0 * ring - 15.0) * kPi / 180.0;
  const double range_m = 1.0 + (i * 37 % 200) * 0.1;
  const Eigen::Vector3d direction(std::cos(azimuth_rad) * std::cos(elevation_rad),
                                  std::sin(azimuth_rad) * std::cos(elevation_rad),
                                  std::sin(elevation_rad));
  return {kSweep_s * share, (range_m * direction).cast<float>()};
}

}  // namespace

Pose3 DrivingRobot::T_odom_base(double t_s) const {
  const double rate_radps = kPi / 3.0, yaw_rad = rate_radps * t_s;
  const double tilt = tilt_deg * std::sin(2.0 * t_s);
  return mount_pose({std::sin(yaw_rad) / rate_radps, (1.0 - std::cos(yaw_rad)) / rate_radps, 0.0},
                    0.7 * tilt, tilt, yaw_rad * 180.0 / kPi);
}

RawCloud SpinningLaser::sweep(double start_s) const {
  RawCloud raw;
  raw.utime_us = kStart_us + std::llround(start_s * 1e6);
  raw.all_rows = static_cast<std::uint32_t>(columns * kRings);
  for (int i = 0; i < columns * kRings; ++i) {
    const Shot s = shot(i, columns);
    raw.points.push_back(s.point);
    raw.times.push_back(static_cast<float>(s.after_s));
    raw.rows.push_back(static_cast<std::uint32_t>(i));
  }
  return raw;
}

std::vector<Eigen::Vector3d> SpinningLaser::truth(const DrivingRobot& robot, double start_s) const {
  const Pose3 T_base_sensor =
      mount_pose({sensor.mount_x_m, sensor.mount_y_m, sensor.mount_z_m}, sensor.mount_roll_deg,
                 sensor.mount_pitch_deg, sensor.mount_yaw_deg);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < columns * kRings; ++i) {
    const Shot s = shot(i, columns);
    points.push_back(robot.T_odom_base(start_s + s.after_s) * T_base_sensor *
                     s.point.cast<double>());
  }
  return points;
}

SpinningLaser tilted_laser() {
  SpinningLaser laser;
  laser.sensor.channel = "LASER_3D";
  laser.sensor.mount_x_m = 0.3;
  laser.sensor.mount_y_m = -0.1;
  laser.sensor.mount_z_m = 0.9;
  laser.sensor.mount_roll_deg = 5.0;
  laser.sensor.mount_pitch_deg = 10.0;
  laser.sensor.mount_yaw_deg = 20.0;
  laser.sensor.time_channel = "time";
  return laser;
}

double greatest_error_m(const Cloud& cloud, const std::vector<Eigen::Vector3d>& truth_odom,
                        const Pose3& T_odom_cloud) {
  if (cloud.points.size() != truth_odom.size() || truth_odom.empty())
    return std::numeric_limits<double>::infinity();
  const Pose3 T_cloud_odom = T_odom_cloud.inverse();
  double greatest_m = 0.0;
  for (std::size_t i = 0; i < truth_odom.size(); ++i) {
    const Eigen::Vector3d error = cloud.points[i].cast<double>() - T_cloud_odom * truth_odom[i];
    greatest_m = std::max(greatest_m, error.norm());
  }
  return greatest_m;
}

}  // namespace voxlist::adapter::test
