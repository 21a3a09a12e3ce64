#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "services/voxlist/output/console.h"
#include "voxlist/adapter/adapter_config.h"
#include "voxlist/matching/localisation/localiser.h"

namespace voxlist::desk {

/// What a drive can tell of a laser's mount.
struct LaserParameter {
  const char* key;  ///< in the sensor's table
  double adapter::SensorConfig::*value;
  int decimals;
  double worst_sd;  ///< what is known worse is not told; two of them are what may be off
  const char* advice;
};

inline constexpr std::array<LaserParameter, 7> kLaserParameters{{
    {"mount_roll_deg", &adapter::SensorConfig::mount_roll_deg, 3, 0.05,
     "drive where a level floor is in sight"},
    {"mount_pitch_deg", &adapter::SensorConfig::mount_pitch_deg, 3, 0.05,
     "drive where a level floor is in sight"},
    {"mount_z_m", &adapter::SensorConfig::mount_z_m, 4, 0.0025,
     "drive where a level floor is in sight"},
    {"mount_yaw_deg", &adapter::SensorConfig::mount_yaw_deg, 3, 0.1,
     "drive straight for some metres, again and again"},
    {"mount_x_m", &adapter::SensorConfig::mount_x_m, 4, 0.01,
     "turn to both sides, again and again"},
    {"mount_y_m", &adapter::SensorConfig::mount_y_m, 4, 0.01,
     "turn to both sides, again and again"},
    {"latency_ms", &adapter::SensorConfig::latency_ms, 2, 1.5,
     "begin and end turns, again and again"},
}};

/// What became of a calibration.
struct LaserCalibration {
  adapter::SensorConfig before, after;

  /// In the parameters' units; nothing where the drive does not tell: such a one stays as it was.
  std::array<std::optional<double>, kLaserParameters.size()> sd;

  /// Each one line: what the drive cannot tell, and what to do.
  std::vector<std::string> refusals;

  std::size_t scans = 0, placed = 0, motions = 0;
};

/// Finds the mount of `config`'s only sensor, and its latency, from a recording of a drive with
/// odometry on a level floor. Roll and pitch must be known to 20 deg before; of yaw, x, y and
/// height nothing.
LaserCalibration calibrate_laser(const std::filesystem::path& log, const std::string& prefix,
                                 adapter::AdapterConfig config,
                                 const matching::LocaliserConfig& localiser, Console& console);

}  // namespace voxlist::desk
