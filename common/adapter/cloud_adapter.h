#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "voxlist/adapter/adapter_config.h"
#include "voxlist/adapter/adapter_report.h"
#include "voxlist/adapter/rate_limit.h"
#include "voxlist/adapter/raw_cloud.h"
#include "voxlist/adapter/robot_motion.h"

namespace voxlist::adapter {

/// Makes clouds in base of what one or several 3D lasers say. Each sensor's newest message waits
/// until all have one (or join_wait_ms is over); then all their points are put where the robot was
/// when they were measured, and all into base at the time of the last of them. Nothing is guessed:
/// a message is used whole, or left out and counted.
///
/// Time is the data's. Equal input in equal order gives equal clouds, bit for bit. Nothing of a
/// message but its times is looked at before its cloud is made, so what is superseded costs little.
class CloudAdapter {
 public:
  /// Throws std::invalid_argument, with the setting's name, for settings that do not fit together.
  explicit CloudAdapter(const AdapterConfig& config);

  /// A message of the sensor with this number in the settings.
  Adapted add_cloud(std::size_t sensor, RawCloud raw);

  Adapted add_odometry(const StampedPose3& T_odom_base);

  /// Nothing more will come: what waits for ODOMETRY goes as far as that is known.
  Adapted finish();

  /// Whether clouds need ODOMETRY.
  bool needs_odometry() const { return needs_odometry_; }

 private:
  struct Sweep {
    std::size_t sensor = 0;
    RawCloud raw;
    PointTimes times;
    std::int64_t last_us = 0;  // of its latest point
  };
  struct Sensor {
    SensorPoints points;
    std::optional<Sweep> newest;
    std::optional<std::int64_t> last_us;
    bool is_absent = false;  // the last CLOUD went out without it
  };
  // What makes one cloud, while odometry has not come so far.
  struct Waiting {
    std::vector<Sweep> sweeps;
    std::int64_t last_us = 0;
    std::int64_t number = 0;
    bool is_slice = false;
  };

  Adapted start() const;
  void start_anew();
  std::optional<Sweep> judge(std::size_t sensor, RawCloud raw, Adapted& out);
  void take(Sweep sweep, Adapted& out);
  bool is_complete() const;
  bool is_overdue(std::int64_t now_us) const;
  void join(std::int64_t now_us, Adapted& out);
  void wait(std::vector<Sweep> sweeps, bool is_slice, Adapted& out);
  void advance(Adapted& out);
  bool knows(std::int64_t utime_us) const;
  std::optional<Cloud> make(const Waiting& waiting, Adapted& out) const;
  bool add(const Sweep& sweep, const Pose3* T_out_odom, Cloud& cloud, SensorReport& report) const;

  const AdapterConfig config_;
  const BodyBoxes robot_;
  const bool needs_odometry_;
  std::vector<Sensor> sensors_;
  RateLimit rate_;
  RobotMotion motion_;
  std::deque<Waiting> waiting_;
  std::int64_t newest_us_ = 0;            // of all that was heard
  std::optional<std::int64_t> start_us_;  // of the first message
};

}  // namespace voxlist::adapter
