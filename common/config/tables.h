#pragma once

#include <string>
#include <vector>

namespace voxlist::config {

/// Every table that a robot's settings file (services/robot.toml) may have: the bus, a list of
/// robots (planning/profiles) that several services read, and one for each service, in the order of
/// services/README.md. A service looks only into its own, and complains about a table that nobody
/// would read.
inline const std::vector<std::string> kTables = {
    "bus",
    "robot",
    "simulator",
    "laser_driver",
    "mirror_monitor",
    "cloud_assembler",
    "cloud_adapter",
    "scan_source",
    "localiser",
    "mapper",
    "octomap_export",
    "grid_export",
    "obstacle_detector",
    "viewer",
    "relay",
};

}  // namespace voxlist::config
