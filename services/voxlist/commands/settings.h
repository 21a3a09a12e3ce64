#pragma once

#include <filesystem>

#include "voxlist/mapping/map_builder.h"
#include "voxlist/matching/localisation/localiser.h"
#include "voxlist/planning/octomap.h"
#include "voxlist/scanner/sweep/cloud_assembler_config.h"

namespace voxlist::desk {

/// What the desk tool takes from a robot's settings file, so that it maps as the robot does.
struct DeskSettings {
  matching::LocaliserConfig localiser;
  mapping::MapBuilderConfig mapper;
  planning::OctomapConfig octomap;
};

/// Reads the tables [localiser], [mapper] and [octomap_export]; an empty path gives the defaults.
/// Throws std::runtime_error with all complaints.
DeskSettings read_settings(const std::filesystem::path& file);

/// The same for the table [cloud_assembler].
scanner::CloudAssemblerConfig read_scanner_settings(const std::filesystem::path& file);

}  // namespace voxlist::desk
