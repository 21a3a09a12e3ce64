#pragma once

#include <filesystem>

#include "mapping/map_builder.h"
#include "matching/localiser.h"
#include "planning/octomap.h"
#include "scanner/cloud_assembler_config.h"

namespace voxlist {

/// What the desk tool takes from a robot's settings file, so that it maps as the robot does.
struct DeskSettings {
  LocaliserConfig localiser;
  MapBuilderConfig mapper;
  OctomapConfig octomap;
};

/// Reads the tables [localiser], [mapper] and [octomap_export]; an empty path gives the defaults.
/// Throws std::runtime_error with all complaints.
DeskSettings read_settings(const std::filesystem::path& file);

/// The same for the table [cloud_assembler].
CloudAssemblerConfig read_scanner_settings(const std::filesystem::path& file);

}  // namespace voxlist
