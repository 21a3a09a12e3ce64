#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "services/voxlist/commands/settings.h"
#include "services/voxlist/output/console.h"

namespace voxlist::desk {

/// Options of `voxlist calibrate`.
struct CalibrateOptions {
  std::filesystem::path log;
  std::filesystem::path config;
  std::filesystem::path output;
  PrefixOption prefix;
  bool laser = false;
  std::string channel;  ///< of the laser, where there are several

  /// Where the robot's present settings stand: nowhere at first.
  std::filesystem::path settings() const;
};

/// Writes what `edit` makes of the present settings; without an output shows what it makes of none.
void give(const CalibrateOptions& options, const std::string& none,
          const std::function<std::string(const std::string&)>& edit, Console& console);

/// The mount of a 3D laser, from a drive. Returns the exit code.
int calibrate_laser(const CalibrateOptions& options, Console& console);

}  // namespace voxlist::desk
