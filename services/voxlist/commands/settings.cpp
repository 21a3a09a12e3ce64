#include "services/voxlist/commands/settings.h"

#include <CLI/CLI.hpp>
#include <map>
#include <stdexcept>

#include "services/voxlist/live/bus_options.h"
#include "voxlist/adapter/cloud_adapter.h"
#include "voxlist/config/config.h"
#include "voxlist/config/tables.h"

namespace voxlist::desk {
namespace {

// Into the sections' structs; throws with all complaints.
void read(const std::filesystem::path& file, const std::vector<config::Section>& sections) {
  if (file.empty()) return;
  std::string all;
  for (const std::string& complaint : config::read_config(file, sections, config::kTables))
    all += (all.empty() ? "" : "\n") + complaint;
  if (!all.empty()) throw std::runtime_error(all);
}

// What no table of ranges tells.
void check_adapter(const std::filesystem::path& file, const adapter::AdapterConfig& config) try {
  if (!config.sensors.empty()) adapter::CloudAdapter{config};
} catch (const std::invalid_argument& error) {
  throw std::runtime_error(file.string() + ": [cloud_adapter] " + error.what());
}

}  // namespace

DeskSettings read_settings(const std::filesystem::path& file) {
  DeskSettings settings;
  read(file, {config::shared_section("localiser", settings.localiser),
              config::shared_section("mapper", settings.mapper),
              config::shared_section("octomap_export", settings.octomap),
              config::section("cloud_adapter", settings.adapter)});
  check_adapter(file, settings.adapter);
  return settings;
}

planning::RobotProfiles read_robots(const std::filesystem::path& file) {
  planning::RobotProfiles robots;
  read(file, {config::root_section(robots)});
  if (const std::string wrong = planning::why_invalid(robots); !wrong.empty())
    throw std::runtime_error(file.string() + ": " + wrong);
  return robots;
}

adapter::AdapterConfig read_adapter_settings(const std::filesystem::path& file) {
  adapter::AdapterConfig settings;
  read(file, {config::section("cloud_adapter", settings)});
  return settings;
}

scanner::CloudAssemblerConfig read_scanner_settings(const std::filesystem::path& file) {
  scanner::CloudAssemblerConfig settings;
  read(file, {config::section("cloud_assembler", settings)});
  return settings;
}

void PrefixOption::add_to(CLI::App& command) {
  option_ = command.add_option("--prefix", text_,
                               "the robot's prefix before each channel's name in a log; default "
                               "that of --config");
}

std::string PrefixOption::of(const std::filesystem::path& settings) const {
  return option_->count() > 0 ? text_ : read_bus_options(settings, "").prefix;
}

void add_tilt(CLI::App& command, std::optional<TiltUse>& tilt) {
  std::map<std::string, TiltUse> names;
  for (std::size_t i = 0; i < kTiltNames.size(); ++i)
    names[kTiltNames[i]] = static_cast<TiltUse>(i);
  command
      .add_option("--tilt", tilt,
                  "planar: scans are level; refine: height, roll and pitch are found too, "
                  "beginning with the floor; odometry: beginning with odometry's")
      ->transform(CLI::CheckedTransformer(names, CLI::ignore_case));
}

void add_match_heights(CLI::App& command, std::vector<double>& heights_m) {
  command
      .add_option("--match-heights", heights_m,
                  "lowest and highest point in m above the floor that takes part in matching, such "
                  "as 1.9 4 in a crowd (match_heights_m in [localiser])")
      ->expected(2);
}

void MakingOptions::add_to(CLI::App& command) {
  command.add_option("--config", config, "the robot's settings (services/robot.toml)");
  prefix.add_to(command);
  command
      .add_option("--octomap-resolution", octomap_resolution_m,
                  "edge of map.bt's voxels in metres; default 0.1")
      ->check(CLI::Range(0.01, 10.0));
  command.add_flag("--no-octomap", no_octomap, "make no map.bt");
  command.add_flag("--carve", carve,
                   "people who walked by and furniture that was moved leave the map (carve = true "
                   "in [mapper])");
  command.add_option("--threads", threads, "most threads; the map does not depend on it")
      ->check(CLI::Range(1, 1024));
  add_tilt(command, tilt);
  add_match_heights(command, match_heights_m);
}

DeskSettings MakingOptions::settings() const {
  DeskSettings settings = read_settings(config);
  if (octomap_resolution_m > 0.0) {
    settings.octomap.resolution_m = octomap_resolution_m;
    settings.octomap.export_resolution_m = 0.0;
  }
  if (carve) settings.mapper.carve = true;
  if (threads > 0) settings.localiser.threads = threads;
  if (tilt) settings.localiser.tilt = *tilt;
  if (!match_heights_m.empty()) settings.localiser.matcher.scan.match_heights_m = match_heights_m;
  return settings;
}

}  // namespace voxlist::desk
