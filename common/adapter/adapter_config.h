#pragma once

#include <array>
#include <string>
#include <vector>

namespace voxlist::adapter {

/// What a point's time is counted in.
enum class TimeUnit { kSeconds, kMilliseconds, kMicroseconds, kNanoseconds };

/// Which of a message's points was measured at its utime.
enum class UtimeOf { kTimeZero, kFirst, kMiddle, kLast };

/// The order in which a laser measures the points of a sweep at constant rate.
enum class SweepOrder { kRows, kClockwise, kCounterclockwise };

/// One laser: what it says, and where it sits.
struct SensorConfig {
  std::string channel;
  double mount_x_m = 0.0;
  double mount_y_m = 0.0;
  double mount_z_m = 0.0;
  double mount_roll_deg = 0.0;
  double mount_pitch_deg = 0.0;
  double mount_yaw_deg = 0.0;
  std::string time_channel;
  TimeUnit time_unit = TimeUnit::kSeconds;
  UtimeOf utime_of = UtimeOf::kTimeZero;
  double sweep_ms = 0.0;
  SweepOrder sweep_order = SweepOrder::kRows;
  double sweep_start_deg = 180.0;
  double latency_ms = 0.0;
  double range_min_m = 0.3;
  double range_max_m = 100.0;
  int max_points = 30'000;

  /// Whether its points are known to be of different times.
  bool has_times() const { return !time_channel.empty() || sweep_ms > 0.0; }

  template <class Visitor>
  void visit(Visitor& v) {
    v("channel", channel, "where the laser's driver publishes pointcloud_t");
    v("mount_x_m", mount_x_m, "the laser in base: forward", -100.0, 100.0);
    v("mount_y_m", mount_y_m, "the laser in base: to the left", -100.0, 100.0);
    v("mount_z_m", mount_z_m, "the laser in base: above the floor", -100.0, 100.0);
    v("mount_roll_deg", mount_roll_deg, "the laser in base: turned about x first", -180.0, 180.0);
    v("mount_pitch_deg", mount_pitch_deg, "then about y: positive looks down", -180.0, 180.0);
    v("mount_yaw_deg", mount_yaw_deg, "then about z: positive looks to the left", -180.0, 180.0);
    v("time_channel", time_channel,
      "which of the message's channels tells when each point was measured; none: see sweep_ms");
    v("time_unit", time_unit, std::array{"s", "ms", "us", "ns"},
      "of that channel: s, ms, us or ns");
    v("utime_of", utime_of, std::array{"zero", "first", "middle", "last"},
      "which point was measured at the message's utime: that of time zero, the first, the last, or "
      "one in the middle between these");
    v("sweep_ms", sweep_ms,
      "without a time channel: how long a sweep at constant rate takes; 0: all points at once", 0.0,
      2000.0);
    v("sweep_order", sweep_order, std::array{"rows", "clockwise", "counterclockwise"},
      "of that sweep: as the message's rows, or as the laser turns, seen from above: rows, "
      "clockwise or counterclockwise");
    v("sweep_start_deg", sweep_start_deg,
      "where a turning sweep starts, about the laser's z axis; 0 is its x axis", -360.0, 360.0);
    v("latency_ms", latency_ms, "the messages' times are late by this against ODOMETRY's", -1000.0,
      1000.0);
    v("range_min_m", range_min_m, "from the laser: nearer points are left out", 0.0, 100.0);
    v("range_max_m", range_max_m, "from the laser: farther points are left out", 0.0, 1000.0);
    v("max_points", max_points, "of a message: from more, about as many are chosen evenly", 100,
      1'000'000);
  }
};

/// Settings of the cloud adapter.
struct AdapterConfig {
  std::vector<double> robot_boxes_m;
  double max_rate_hz = 10.0;
  bool use_odometry = true;
  bool level = false;
  double odometry_extrapolation_ms = 25.0;
  double max_wait_ms = 200.0;
  double join_wait_ms = 150.0;
  bool slices = false;
  std::vector<SensorConfig> sensors;

  template <class Visitor>
  void visit(Visitor& v) {
    v("robot_boxes_m", robot_boxes_m,
      "the robot's own body, left out: boxes in base, each x from, x to, y from, y to, z from, z "
      "to",
      -100.0, 100.0);
    v("max_rate_hz", max_rate_hz, "clouds a second at most, in the mean: older ones are left out",
      0.1, 100.0);
    v("use_odometry", use_odometry,
      "put each point where the robot was then; false: for a robot that stands, or has no "
      "ODOMETRY");
    v("level", level,
      "turn the cloud level by ODOMETRY's roll and pitch; then nobody after this may do so again");
    v("odometry_extrapolation_ms", odometry_extrapolation_ms,
      "how long the robot is trusted to move on at ODOMETRY's last velocity; a cloud that ends "
      "later "
      "waits",
      0.0, 1000.0);
    v("max_wait_ms", max_wait_ms, "how long a cloud may wait for ODOMETRY, then it is dropped", 0.0,
      1000.0);
    v("join_wait_ms", join_wait_ms, "how long one sensor's cloud waits for those of the others",
      0.0, 2000.0);
    v("slices", slices,
      "publish each sensor's cloud by itself on CLOUD_SLICE, too, at its own rate");
    v("sensor", sensors, "a 3D laser; several give one CLOUD");
  }
};

}  // namespace voxlist::adapter
