#include "services/voxlist/maps/laser_calibration.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <sstream>

#include "services/voxlist/maps/laser_drive.h"
#include "services/voxlist/recording/adapted_recording.h"
#include "voxlist/calibration/laser/mount_fit.h"
#include "voxlist/geometry/angle.h"
#include "voxlist/geometry/mount.h"

namespace voxlist::desk {
namespace {

using adapter::SensorConfig;

// Scans that level the laser roughly, so that the others can be placed.
constexpr std::size_t kFirstScans = 60;

// The drive is looked at so often: as it was measured, then de-skewed by the mount that was found,
// and again by a better one.
constexpr int kLooks = 3;

// Points of a scan that are used: more take time and tell no more.
constexpr int kPoints = 10'000;

// Neighbouring scans see the same unevenness of the floor: so many count for one.
constexpr double kAlike = 10.0;

// Fewer scans that show the floor, or a smaller share that could be placed, are no ground to stand
// on.
constexpr std::size_t kFewestFloors = 10;
constexpr double kLeastShare = 0.5;

// In the order of kLaserParameters.
enum { kRoll, kPitch, kHeight, kYaw, kX, kY, kLatency };

Pose3 mount_of(const SensorConfig& sensor) {
  return mount_pose({sensor.mount_x_m, sensor.mount_y_m, sensor.mount_z_m}, sensor.mount_roll_deg,
                    sensor.mount_pitch_deg, sensor.mount_yaw_deg);
}

void set_mount(const Pose3& T_base_sensor, SensorConfig& sensor) {
  const Pose2 plane = to_pose2(T_base_sensor);
  const Tilt tilt = tilt_of(T_base_sensor);
  sensor.mount_x_m = plane.x_m;
  sensor.mount_y_m = plane.y_m;
  sensor.mount_yaw_deg = plane.yaw_rad / kRadPerDeg;
  sensor.mount_z_m = tilt.z_m;
  sensor.mount_roll_deg = tilt.roll_rad / kRadPerDeg;
  sensor.mount_pitch_deg = tilt.pitch_rad / kRadPerDeg;
}

// The middle of what scans say, and its standard deviation.
struct Level {
  Tilt middle, sd;
};

double middle_of(const std::vector<Tilt>& floors, double Tilt::*part) {
  std::vector<double> values;
  for (const Tilt& floor : floors) values.push_back(floor.*part);
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double sd_of(const std::vector<Tilt>& floors, double Tilt::*part, double middle) {
  double squares = 0.0;
  for (const Tilt& floor : floors) squares += (floor.*part - middle) * (floor.*part - middle);
  const auto n = static_cast<double>(floors.size());
  return std::sqrt(squares / n * kAlike / n);
}

Level level_of(const std::vector<Tilt>& floors) {
  Level level;
  for (double Tilt::*const part : {&Tilt::z_m, &Tilt::roll_rad, &Tilt::pitch_rad}) {
    level.middle.*part = middle_of(floors, part);
    level.sd.*part = sd_of(floors, part, level.middle.*part);
  }
  return level;
}

bool is_enough(std::size_t part, std::size_t all) {
  return static_cast<double>(part) > kLeastShare * static_cast<double>(all);
}

class Calibrator {
 public:
  Calibrator(std::filesystem::path log, std::string prefix, adapter::AdapterConfig config,
             const matching::LocaliserConfig& localiser, Console& console)
      : log_(std::move(log)),
        prefix_(std::move(prefix)),
        config_(std::move(config)),
        localiser_(localiser),
        told_(console) {
    result_.before = config_.sensors.front();
    config_.robot_boxes_m.clear();  // they are where the mount says, which is not known yet
    config_.sensors.front().max_points = std::min(kPoints, result_.before.max_points);
  }

  LaserCalibration run() {
    for (int i = 0; i < 2; ++i) level(see_floors(*open(false), kFirstScans));
    for (int look = 0; look < kLooks; ++look) {
      const bool deskews = look > 0;
      const SeenDrive seen = see_drive(*open(deskews), localiser_);
      const bool is_level = level(seen);
      const auto fit = calibration::fit_mount(seen.drive);
      result_.scans = seen.scans;
      result_.placed = seen.drive.scans.size();
      if (!fit || !is_enough(result_.placed, result_.scans)) return refused(is_level);
      result_.motions = fit->motions;
      move(*fit, deskews);
    }
    return judged();
  }

 private:
  std::unique_ptr<Recording> open(bool deskews) {
    adapter::AdapterConfig config = config_;
    config.use_odometry = deskews;
    Omissions& omissions = passes_++ == 0 ? told_ : untold_;
    return adapted(open_recording(log_, prefix_, omissions, channels_of(config)), config,
                   omissions);
  }

  SensorConfig& sensor() { return config_.sensors.front(); }

  // Whether enough scans show the floor.
  bool level(const SeenDrive& seen) {
    for (const int i : {kRoll, kPitch, kHeight}) sd_[static_cast<std::size_t>(i)] = INFINITY;
    if (seen.floors.size() < kFewestFloors) return false;
    const Level level = level_of(seen.floors);
    set_mount(to_level(level.middle) * mount_of(sensor()), sensor());
    sd_[kRoll] = level.sd.roll_rad / kRadPerDeg;
    sd_[kPitch] = level.sd.pitch_rad / kRadPerDeg;
    sd_[kHeight] = level.sd.z_m;
    return true;
  }

  void move(const calibration::MountFit& fit, bool deskewed) {
    const auto& is = fit.correction;
    const Pose2 T_base_assumed{is[calibration::kMountX], is[calibration::kMountY],
                               is[calibration::kMountYaw]};
    set_mount(to_pose3(T_base_assumed) * mount_of(sensor()), sensor());
    // A sweep that is not de-skewed is of another time than its last point's.
    if (deskewed) sensor().latency_ms += 1e3 * is[calibration::kMountLatency];
    sd_[kX] = fit.sd[calibration::kMountX];
    sd_[kY] = fit.sd[calibration::kMountY];
    sd_[kYaw] = fit.sd[calibration::kMountYaw] / kRadPerDeg;
    sd_[kLatency] = 1e3 * fit.sd[calibration::kMountLatency];
  }

  LaserCalibration refused(bool is_level) {
    for (const int i : {kYaw, kX, kY, kLatency}) sd_[static_cast<std::size_t>(i)] = INFINITY;
    if (is_level)
      result_.refusals.push_back(
          is_enough(result_.placed, result_.scans)
              ? "ODOMETRY goes along with too little of the drive: at least 10 s of both are needed"
              : fmt::format("only {} of {} scans fit a map of them: drive slower, in a room with "
                            "walls",
                            result_.placed, result_.scans));
    return judged();
  }

  LaserCalibration judged() {
    result_.after = result_.before;
    for (std::size_t i = 0; i < kLaserParameters.size(); ++i) {
      const LaserParameter& parameter = kLaserParameters[i];
      if (sd_[i] <= parameter.worst_sd) {
        result_.sd[i] = sd_[i];
        result_.after.*parameter.value = sensor().*parameter.value;
      } else {
        result_.refusals.push_back(fmt::format(
            "{}: this drive does not tell it (sd {:.{}f}, {:g} is wanted): {}", parameter.key,
            sd_[i], parameter.decimals, parameter.worst_sd, parameter.advice));
      }
    }
    return std::move(result_);
  }

  const std::filesystem::path log_;
  const std::string prefix_;
  adapter::AdapterConfig config_;
  const matching::LocaliserConfig& localiser_;
  std::ostringstream nowhere_;
  Console silent_{nowhere_, nowhere_, false};
  Omissions told_, untold_{silent_};
  int passes_ = 0;
  std::array<double, kLaserParameters.size()> sd_{};
  LaserCalibration result_;
};

}  // namespace

LaserCalibration calibrate_laser(const std::filesystem::path& log, const std::string& prefix,
                                 adapter::AdapterConfig config,
                                 const matching::LocaliserConfig& localiser, Console& console) {
  return Calibrator(log, prefix, std::move(config), localiser, console).run();
}

}  // namespace voxlist::desk
