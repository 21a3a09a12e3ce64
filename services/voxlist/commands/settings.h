#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "voxlist/adapter/adapter_config.h"
#include "voxlist/mapping/map_builder.h"
#include "voxlist/matching/localisation/localiser.h"
#include "voxlist/planning/octomap.h"
#include "voxlist/planning/profiles/robot_profile.h"
#include "voxlist/scanner/sweep/cloud_assembler_config.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace voxlist::desk {

/// What the desk tool takes from a robot's settings file, so that it maps as the robot does.
struct DeskSettings {
  matching::LocaliserConfig localiser;
  mapping::MapBuilderConfig mapper;
  planning::OctomapConfig octomap;
  /// No sensors: scans are in base already.
  adapter::AdapterConfig adapter;
};

/// The robot's prefix before each channel's name in a log: --prefix, else that of its settings.
class PrefixOption {
 public:
  /// Adds it to a command. It must outlive it.
  void add_to(CLI::App& command);

  /// Throws std::runtime_error with all complaints about the settings file.
  std::string of(const std::filesystem::path& settings) const;

 private:
  std::string text_;
  const CLI::Option* option_ = nullptr;
};

/// Reads the tables [localiser], [mapper], [octomap_export] and [cloud_adapter]; an empty path
/// gives the defaults. Throws std::runtime_error with all complaints.
DeskSettings read_settings(const std::filesystem::path& file);

/// The same for the list [[robot]]; robots that cannot be told apart are a complaint, too.
planning::RobotProfiles read_robots(const std::filesystem::path& file);

/// The same for the table [cloud_adapter].
adapter::AdapterConfig read_adapter_settings(const std::filesystem::path& file);

/// The same for the table [cloud_assembler].
scanner::CloudAssemblerConfig read_scanner_settings(const std::filesystem::path& file);

/// Adds --tilt, which overrides that of the settings. `tilt` must outlive the command.
void add_tilt(CLI::App& command, std::optional<TiltUse>& tilt);

/// Adds --match-heights, which overrides those of the settings where it is given. `heights_m` must
/// outlive the command.
void add_match_heights(CLI::App& command, std::vector<double>& heights_m);

/// Options of the commands that make maps.
struct MakingOptions {
  std::filesystem::path config;
  PrefixOption prefix;
  double octomap_resolution_m = 0.0;
  bool no_octomap = false;
  bool carve = false;
  int threads = 0;
  std::optional<TiltUse> tilt;
  std::vector<double> match_heights_m;

  /// Adds them to a command. They must outlive it.
  void add_to(CLI::App& command);

  /// The settings of the robot's file, with what the options say otherwise. Throws as
  /// read_settings.
  DeskSettings settings() const;
};

}  // namespace voxlist::desk
